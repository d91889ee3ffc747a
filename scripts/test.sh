#!/usr/bin/env bash
# Sets up what is missing, then runs every check and test. The last line says how many passed and failed.
#
#   scripts/test.sh [--jobs N]     at most N test files with processes at a time (3)
#   scripts/test.sh --fast         those of changed packages and the core's quick ones, without processes
#   scripts/test.sh FILE...        only these files
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests
enter_workspace
cd "$root"
exec python3 scripts/run_tests.py "$@"
