#!/usr/bin/env bash
# Its program and exit code: run.sh.
. "$(dirname "${BASH_SOURCE[0]}")/run.sh"
