#!/usr/bin/env bash
# Does bad things to drives: sets up what is missing, then keeps what it finds in out/chaos/.
#
#   scripts/chaos.sh [--rounds N] [--seed N] [--course course|race|lane_empty] [--only FAULT]
#
# Exit code 0: nothing found; 1: something; 2: could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/chaos/chaos.py" "$@"
