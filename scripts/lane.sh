#!/usr/bin/env bash
# Drives the lane course with its zebra crossings by camera, and writes out/lane/ as scripts/course.sh does.
#
#   scripts/lane.sh [--method NAME] [--empty] [--laps N] [--duration S] [--out DIR] [--fast]
#                   [--seed N]
#
# --empty: nobody crosses; writes out/lane_empty/. NAME: a module in lane_keeping's methods/.
# Exit code 0: all laps were completed, or with --duration and no --laps it drove that long; 1: the car left
# the lane, stalled or ran out of time; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
course=lane
arguments=()
while (($#)); do
  case $1 in
    --empty) course=lane_empty ;;
    --method)
      value=${2:-}
      mapfile -t names < <(methods)
      known "$value" $"no method '$value' (METHOD=); there are:" "${names[@]}"
      arguments+=(--follower "$2.py"); shift ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
"$root/scripts/setup.sh" || exit 2
enter_workspace
exec python3 "$root/src/evaluation/scripts/course_run.py" --course "$course" "${arguments[@]}"
