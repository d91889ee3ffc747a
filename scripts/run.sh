#!/usr/bin/env bash
# Sets up what is missing, then runs the program of the name of the script that sources it: NAME.sh, for make NAME. (Links
# to it would be text on Windows, where Docker Desktop mounts this folder from.) `scripts/NAME.sh --help` lists its options;
# what it makes is in out/NAME/. NAME.sh and its exit code 0:
#
#   course               drives the line course (--fast: in lockstep with the follower): all laps were completed, or with a
#                        duration and no laps it drove that long
#   replay               goes back to an image of a run: the state there is the run's
#   navigate             maps a house and drives to goals: all reached without contact, map and pose within their limits
#   track                follows the red cylinder: it was reached and its distance kept
#   avoid                drives by laser through halls with columns: all goals reached without contact
#   autorace             drives the missions of AutoRace 2020: each passed in every drive
#   race_trials          many laps of the racecar, each with its own light: those of the first follower within the limits
#   track_trials         many runs after the red cylinder: enough of each set succeeded
#   lane_trials          laps of the lane in varying light, then people crossing: all results within the limits
#   navigation_trials    move_base in narrow yards and among people: 95 % of the yards crossed and nobody touched
#   localisation_trials  amcl: global localisation, kidnapped robot, tracking: all results within the limits
#   bench_lanes, bench   compares the lane detection methods; benchmarks: all was measured, whatever the results
#   fuzz, chaos, soak    malformed input; faults during drives; hours of activity: no fault found, nothing grows
#   mutants              mutation testing of the core: at least 85 % of the mutants are detected
#
# Exit code 1: it was not so; 2: it could not run. (make ends with 2 for both, and prints the code: "Error 1".)
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
words=("$@") course=course
for at in "${!words[@]}"; do [ "${words[at]}" != --course ] || course=${words[at + 1]:-}; done
for at in "${!words[@]}"; do
  value=${words[at + 1]:-}
  case "$self ${words[at]}" in
    "course --follower")
      mapfile -t names < <(followers "$course")
      [[ " $* " == *" --launch "* ]] || known "$value" $"no follower '$value' (FOLLOWER=); there are:" "${names[@]}" ;;
    "course --camera")
      [[ $value =~ ^[1-9][0-9]{0,4}x[1-9][0-9]{0,4}$ ]] ||
        fail $"--camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480; got '$value'" ;;
    "replay --run")
      [ -e "$value" ] || [ -e "$value.run.log.gz" ] ||
        fail $"no run at $value (RUN=): give the folder of its results, as out/course" ;;
    "track --scene")
      known "$value" $"no scene '$value' (SCENE=); there are:" $(quoted_words src/lessons/ai_robot_tracking/src/ai_robot_tracking/scenes/scene.py "KINDS = (" ")") ;;
    "track --tracker") known "$value" $"no tracker '$value' (TRACKER=); there are:" visual_tracker.py visual_tracker_pid.py ;;
    "lane_trials --method")
      mapfile -t names < <(methods)
      known "$value" $"no method '$value' (METHOD=); there are:" "${names[@]}" ;;
    "autorace --mission") known "$value" $"no mission '$value' (MISSION=); there are:" $(quoted_words src/evaluation/src/evaluation/autorace.py "^TASKS = {" "^}") all ;;
    "chaos --course") known "$value" $"no course '$value' (COURSE=); there are:" course race lane_empty ;;
    "soak --course") known "$value" $"no course '$value' (COURSE=); there are:" course race navigation ;;
  esac
done
case $self in
  fuzz | chaos | soak | mutants) "$root/scripts/setup.sh" --tests || exit 2; program=test/$self/$self.py ;;
  bench) "$root/scripts/setup.sh" --learning || exit 2; program=src/sim_bench/scripts/bench.py ;;
  run) fail "call the script of a program, such as scripts/course.sh" ;;
  *) set_up_trial "$@"; program=src/evaluation/scripts/${self/%course/course_run}.py ;;
esac
enter_workspace
end_with_terminal
exec python3 "$root/$program" "$@"
