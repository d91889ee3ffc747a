#!/usr/bin/env bash
# Follows the red cylinder of ai_robot_tracking without a screen: out/track/.
#
#   scripts/track.sh [--scene static|moving|light|occlusion|distractors] [--seed N]
#                    [--tracker visual_tracker_pid.py|visual_tracker.py] [--keep S] [--fast] [--out DIR]
#
# Exit code 0: the target was reached and its distance kept; 1: not so; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" || exit 2
enter_workspace
exec python3 "$root/src/evaluation/scripts/track.py" "$@"
