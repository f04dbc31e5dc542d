# What setup, demo and test share. Sourced, not run.
set -eu -o pipefail

root="$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")"
workspace="$root/.catkin_ws"

# The system's python3 has the ROS modules; one that the user put in front of it does not.
export PATH="/usr/bin:$PATH"

say() { echo "[laparoscope_servo] $*"; }

fail() {
  echo "[laparoscope_servo] error: $*" >&2
  exit 1
}

# make_workspace ARGUMENTS: catkin_make here. A shell that has sourced this very workspace must not become part of what is
# configured: an installed package would then name the folder that it was built in.
make_workspace() {
  local path=":${CMAKE_PREFIX_PATH:-}:"
  path="${path//:$workspace\/devel:/:}"
  path="${path#:}"
  CMAKE_PREFIX_PATH="${path%:}" catkin_make -C "$workspace" "$@"
}

# Sources a setup.bash, which was not written for `set -u`.
source_ros() {
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}
