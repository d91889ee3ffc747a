#!/usr/bin/env bash
# Changes the core's code in small ways and counts what its tests notice: sets up what is missing, then writes to out/mutants/.
#
#   scripts/mutants.sh [--sample N] [--seed N]
#
# Exit code 0: at least 85 % are noticed; 1: fewer; 2: could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/mutants/mutants.py" "$@"
