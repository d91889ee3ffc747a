#!/usr/bin/env bash
# The main command: sets up what is missing, then drives the line course and writes out/course/.
#
#   scripts/course.sh [--laps N] [--duration S] [--follower FILE] [--out DIR]
#                     [--fast] [--camera WIDTHxHEIGHT] [--seed N]
#
# --fast: as fast as possible, in lockstep: after each image the world waits for the follower's command.
# Exit code 0: all laps were completed; 1: the car left the course or stalled; 2: it could not run.
# (`make course` ends with 2 for any failure, as make does, and prints the code above: "Error 1".)
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" || exit 2
enter_workspace
exec python3 "$root/src/evaluation/scripts/course_run.py" "$@"
