#!/usr/bin/env bash
# Sets up what is missing, fuzzes with malformed files, requests and messages, and keeps what it finds in out/fuzz/.
#
#   scripts/fuzz.sh [--minutes M] [--target NAME] [--seed N]
#   scripts/fuzz.sh --target NAME --input FILE    repeats one input
#
# Exit code 0: no fault found; 1: some found; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/fuzz/fuzz.py" "$@"
