# shellcheck shell=sh
# What is started from this shell listens on the loopback address alone, unless ROS_IP, ROS_HOSTNAME or ROS_MASTER_URI tell
# of other machines: ROS 1 asks nobody who he is (doc/network.md).

# Whether a host, in lower case, is this machine: by its names, its addresses, or what its name resolves to.
_laparoscope_servo_is_here() {
  _laparoscope_servo_node=$(uname -n | tr '[:upper:]' '[:lower:]')
  case "$1" in
    localhost | ip6-localhost | 0.0.0.0 | ::1 | :: | ::ffff:127.*) return 0 ;;
    "$_laparoscope_servo_node" | "${_laparoscope_servo_node%%.*}") return 0 ;;
  esac
  for _laparoscope_servo_address in "$1" $(timeout 2 getent ahosts "$1" 2>/dev/null | cut -d ' ' -f 1); do
    case "$_laparoscope_servo_address" in
      *[!0-9a-f.:]*) continue ;; # a name
      127.* | ::1) return 0 ;;
    esac
    case " $(hostname -I 2>/dev/null || :) " in
      *" $_laparoscope_servo_address "*) return 0 ;;
    esac
  done
  return 1
}

if [ -z "${ROS_IP:-}${ROS_HOSTNAME:-}" ]; then
  _laparoscope_servo_rest="${ROS_MASTER_URI:-http://localhost}"
  _laparoscope_servo_rest="${_laparoscope_servo_rest#*://}"
  case "$_laparoscope_servo_rest" in
    '['*) # [::1]:11311
      _laparoscope_servo_host="${_laparoscope_servo_rest#?}"
      _laparoscope_servo_host="${_laparoscope_servo_host%%]*}"
      _laparoscope_servo_rest="${_laparoscope_servo_rest#*]}"
      ;;
    *)
      _laparoscope_servo_host="${_laparoscope_servo_rest%%[:/]*}"
      _laparoscope_servo_rest="${_laparoscope_servo_rest#"$_laparoscope_servo_host"}"
      ;;
  esac
  _laparoscope_servo_host=$(printf %s "${_laparoscope_servo_host%.}" | tr '[:upper:]' '[:lower:]')
  if _laparoscope_servo_is_here "$_laparoscope_servo_host"; then
    export ROS_IP=127.0.0.1
    # Where the master then listens: not on 127.0.1.1, which Debian gives to the machine's own name, nor on its other addresses.
    case "$_laparoscope_servo_host:${ROS_MASTER_URI:-}" in
      *: | *:http://localhost | *:http://localhost[:/]* | 127.0.0.1:*) ;;
      *) export ROS_MASTER_URI="http://localhost$_laparoscope_servo_rest" ;;
    esac
  fi
  unset _laparoscope_servo_rest _laparoscope_servo_host _laparoscope_servo_node _laparoscope_servo_address
fi
unset -f _laparoscope_servo_is_here

# ROS_IP alone is not enough for roscpp: see src/loopback. Programs of this package have it built in; rosout, which roslaunch
# starts beside the master, is given it by a roscore.xml, unless somebody has one of his own.
_laparoscope_servo_core="$CATKIN_ENV_HOOK_WORKSPACE/share/laparoscope_servo/loopback"
case "${ROS_ETC_DIR:-/etc/ros}" in
  */etc/ros | */share/laparoscope_servo/loopback)
    [ ! -f "$_laparoscope_servo_core/roscore.xml" ] || export ROS_ETC_DIR="$_laparoscope_servo_core"
    ;;
esac
unset _laparoscope_servo_core
