#!/usr/bin/env bash
# Sets up what is missing, injects faults into drives, and keeps what it finds in out/chaos/.
#
#   scripts/chaos.sh [--rounds N] [--seed N] [--course course|race|lane_empty] [--only FAULT]
#
# Exit code 0: no fault found; 1: some found; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/chaos/chaos.py" "$@"
