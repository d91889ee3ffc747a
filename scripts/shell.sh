#!/usr/bin/env bash
# A terminal in which the lessons' commands work, on any Linux: bash with the workspace sourced. `exit` ends it.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" || exit 2
[ -z "${given_master[0]}" ] || export ROS_MASTER_URI=${given_master[0]}
export PATH=$PATH:/usr/games
bash --rcfile <(printf '%s\n' '[ ! -f ~/.bashrc ] || . ~/.bashrc' ". $root/devel/setup.bash" 'PS1="(courses) ${PS1:-\$ }"') || exit 0  # make has nothing to report
