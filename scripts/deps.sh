#!/usr/bin/env bash
# Installs the Debian packages that the packages of a workspace ask for, and says what nobody has.
#
#   scripts/deps.sh [--simulate] [WORKSPACE]     WORKSPACE: such as ~/catkin_ws; this one unless given
#
# Exit code 0: all that can be had is installed; 1: apt could not; 2: there is no such workspace.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
[ -f "$root/devel/setup.bash" ] || fail "this workspace is not built yet: make setup"
arguments=() workspace=$root
for word in "$@"; do
  case $word in
    --simulate) arguments+=("$word") ;;
    -*) fail "unknown option $word; there is --simulate" ;;
    *) workspace=$word ;;
  esac
done
enter_workspace
exec rosrun workspace_needs deps "${arguments[@]}" "$workspace"
