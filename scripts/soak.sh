#!/usr/bin/env bash
# Runs a course for hours with user activity: sets up what is missing, then writes to out/soak/.
#
#   scripts/soak.sh [--hours H] [--course course|race|navigation]
#
# Exit code 0: nothing grows; 1: something grows, or the robot stands; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/soak/soak.py" "$@"
