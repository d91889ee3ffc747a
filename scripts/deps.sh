#!/usr/bin/env bash
# Installs the Debian packages that a workspace's packages depend on, and reports what is not available.
#
#   scripts/deps.sh [--simulate] [WORKSPACE]     WORKSPACE: such as ~/catkin_ws; default: this one
#
# Exit code 0: all that is available is installed; 1: apt failed; 2: there is no such workspace.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
python3 -c 'import catkin_pkg, rospkg, yaml' 2>/dev/null || fail $"Debian's ROS is not installed yet: make setup"
arguments=() workspace=$root
for word in "$@"; do
  case $word in
    --simulate) arguments+=("$word") ;;
    -*) fail $"unknown option $word; there is --simulate" ;;
    *) workspace=$word ;;
  esac
done
# Not with `rosrun`: a missing package may be why this workspace could not be built.
compat=$root/src/compat
PYTHONPATH=$root/src/workspace_needs/src:$root/src/interfaces/node_basics/src
export PYTHONPATH=$PYTHONPATH:$compat/python_amendments/src:$root/src/interfaces/terminal_language/src
export ROS_PACKAGE_PATH=$root/src:/usr/share
exec python3 -m workspace_needs.command "${arguments[@]}" "$workspace"
