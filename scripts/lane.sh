#!/usr/bin/env bash
# Keeps the lane with its zebra crossings by camera, and writes out/lane/ as scripts/course.sh does.
#
#   scripts/lane.sh [--method NAME] [--empty] [--laps N] [--duration S] [--out DIR] [--fast]
#                   [--seed N]
#
# --empty: nobody crosses; writes out/lane_empty/. NAME: a file of src/lane_keeping/methods.
# Exit code 0: the laps were closed; 1: the car left the lane or stalled; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
course=lane
arguments=()
while (($#)); do
  case $1 in
    --empty) course=lane_empty ;;
    --method) arguments+=(--follower "${2:-}.py"); shift $(($# > 1)) ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
"$root/scripts/setup.sh" || exit 2
enter_workspace
exec python3 "$root/src/evaluation/scripts/course_run.py" --course "$course" "${arguments[@]}"
