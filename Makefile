# Every verb is a script in scripts/; run a script by itself to see its own exit code.
.PHONY: help course race race-trials navigate navigation-trials drive viewer test bench setup build lint clean

help: ## list the verbs
	@scripts/help.sh

course: ## drive the line course and report [LAPS=1] [DURATION=s] [FOLLOWER=06follower_pid.py] [FAST=1] [CAMERA=640x480] [SEED=0]
	@scripts/course.sh $(if $(LAPS),--laps "$(LAPS)") $(if $(DURATION),--duration "$(DURATION)") \
	  $(if $(FOLLOWER),--follower "$(FOLLOWER)") $(if $(filter-out 0 no false,$(FAST)),--fast) \
	  $(if $(CAMERA),--camera "$(CAMERA)") $(if $(SEED),--seed "$(SEED)")

race: ## drive the racetrack by camera and report [LAPS= DURATION= FAST= CAMERA= SEED= FOLLOWER=lane_follow_p.py]
	@scripts/course.sh --course race $(if $(LAPS),--laps "$(LAPS)") \
	  $(if $(DURATION),--duration "$(DURATION)") $(if $(FOLLOWER),--follower "$(FOLLOWER)") \
	  $(if $(filter-out 0 no false,$(FAST)),--fast) $(if $(CAMERA),--camera "$(CAMERA)") \
	  $(if $(SEED),--seed "$(SEED)")

race-trials: ## many disturbed laps, lane_follow beside plain P [SEEDS=20] [TRACKS=10]
	@scripts/race_trials.sh $(if $(SEEDS),--seeds "$(SEEDS)") $(if $(TRACKS),--tracks "$(TRACKS)")

navigate: ## map the house, localise, visit goals, report [GOALS=5] [SEED=0] [PACE=1] [MAP=out/navigate/map.yaml]
	@scripts/navigate.sh $(if $(GOALS),--goals "$(GOALS)") $(if $(SEED),--seed "$(SEED)") \
	  $(if $(PACE),--real-time-factor "$(PACE)") $(if $(MAP),--map "$(MAP)")

navigation-trials: ## move_base through narrow worlds, and past persons [YARDS=50] [REPEATS=2] [CROSSINGS=20] [PACE=1]
	@scripts/navigation_trials.sh $(if $(YARDS),--yards "$(YARDS)") $(if $(REPEATS),--repeats "$(REPEATS)") \
	  $(if $(CROSSINGS),--crossings "$(CROSSINGS)") $(if $(PACE),--real-time-factor "$(PACE)")

drive: ## drive the racecar with the WASD keys, in a window or in this terminal
	@scripts/drive.sh

viewer: ## the course, and a page in the browser that shows it [CONTROL=1] [PORT=8080] [ADDRESS=0.0.0.0]
	@scripts/viewer.sh $(if $(filter-out 0 no false,$(CONTROL)),control:=true) \
	  $(if $(PORT),"port:=$(PORT)") $(if $(ADDRESS),"address:=$(ADDRESS)")

test: ## run every check and test [JOBS=3]
	@scripts/test.sh $(if $(JOBS),--jobs "$(JOBS)")

bench: ## measure, into out/bench/ [ONLY=renderer,step] [QUICK=1] [MEMORY_S=30000]
	@scripts/bench.sh $(if $(ONLY),--only "$(ONLY)") $(if $(filter-out 0 no false,$(QUICK)),--quick) \
	  $(if $(MEMORY_S),--memory-s "$(MEMORY_S)")

setup: ## install what is missing, and build
	@scripts/setup.sh

build: ## build the workspace again
	@scripts/setup.sh --build

lint: ## check the style of the Python code
	@scripts/lint.sh

clean: ## remove what was installed and built here (out/ stays)
	@scripts/clean.sh
