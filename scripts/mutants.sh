#!/usr/bin/env bash
# Mutation testing of the core: sets up what is missing, then writes to out/mutants/.
#
#   scripts/mutants.sh [--sample N] [--seed N]
#
# Exit code 0: at least 85 % of the mutants are detected; 1: fewer; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests || exit 2
enter_workspace
exec python3 "$root/test/mutants/mutants.py" "$@"
