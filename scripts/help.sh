#!/usr/bin/env bash
# Lists the Makefile's commands.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
echo "usage: make COMMAND [OPTION=VALUE ...]"
sed -n 's/^\([a-z-]*\):.*## \(.*\)/  \1\t\2/p' "$root/Makefile" | expand -t 23
echo "Then, in each new terminal: source devel/setup.bash"
