#!/usr/bin/env bash
# Lets a course run for hours with people beside it: sets up what is missing, then writes to out/soak/.
#
#   scripts/soak.sh [--hours H] [--course course|race|navigation]
#
# Exit code 0: all is flat; 1: something grows; 2: could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/soak/soak.py" "$@"
