# shellcheck shell=sh
# What is started from this shell listens on the loopback address alone, unless ROS_IP, ROS_HOSTNAME or ROS_MASTER_URI tell
# of other machines: ROS 1 asks nobody who he is (doc/network.md).
if [ -z "${ROS_IP:-}${ROS_HOSTNAME:-}" ]; then
  case "${ROS_MASTER_URI:-http://localhost}" in
    http://localhost | http://localhost[:/]* | http://127.*) export ROS_IP=127.0.0.1 ;;
  esac
fi

# ROS_IP alone is not enough: see src/loopback. The library heeds it, too, and changes nothing for other addresses.
_laparoscope_servo_library="$CATKIN_ENV_HOOK_WORKSPACE/lib/liblaparoscope_servo_loopback.so"
case "$_laparoscope_servo_library:${LD_PRELOAD:-}" in
  *' '*:* | *:*"$_laparoscope_servo_library"*) ;; # a space would end its name; it is there already
  *) [ ! -f "$_laparoscope_servo_library" ] || export LD_PRELOAD="$_laparoscope_servo_library${LD_PRELOAD:+:$LD_PRELOAD}" ;;
esac
unset _laparoscope_servo_library
