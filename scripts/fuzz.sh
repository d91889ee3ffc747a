#!/usr/bin/env bash
# Gives spoilt files, requests and messages to what takes them: sets up what is missing, then keeps what it finds in out/fuzz/.
#
#   scripts/fuzz.sh [--minutes M] [--target NAME] [--seed N]
#   scripts/fuzz.sh --target NAME --input FILE    one input once more
#
# Exit code 0: nothing found; 1: something; 2: could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/fuzz/fuzz.py" "$@"
