#!/usr/bin/env bash
# Installs the Debian packages that the packages of a workspace ask for, and says what nobody has.
#
#   scripts/deps.sh [--simulate] [WORKSPACE]     WORKSPACE: such as ~/catkin_ws; this one unless given
#
# Exit code 0: all that can be had is installed; 1: apt could not; 2: there is no such workspace.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
python3 -c 'import catkin_pkg, rospkg, yaml' 2>/dev/null || fail "Debian's ROS is not installed yet: make setup"
arguments=() workspace=$root
for word in "$@"; do
  case $word in
    --simulate) arguments+=("$word") ;;
    -*) fail "unknown option $word; there is --simulate" ;;
    *) workspace=$word ;;
  esac
done
# Not by `rosrun`: what is missing may be what keeps this workspace from being built.
export PYTHONPATH=$root/src/workspace_needs/src ROS_PACKAGE_PATH=$root/src:/usr/share
exec python3 -m workspace_needs.command "${arguments[@]}" "$workspace"
