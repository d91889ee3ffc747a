# Every command is a script in scripts/; run a script itself to get its own exit code.
verbs = setup course race replay viewer lab drive lane track avoid navigate autorace mark grade site shell deps build report clean clean-root help \
  test lint race-trials track-trials lane-trials navigation-trials localisation-trials bench-lanes bench fuzz chaos soak mutants check-releases deb image wheels
.PHONY: $(verbs)
.DEFAULT_GOAL = help

# Where the cases of a trial run: WORKERS= of them at a time here, or on the workers of SCHEDULER=.
WHERE = $(if $(WORKERS),--workers "$$WORKERS") $(if $(SCHEDULER),--scheduler "$$SCHEDULER")

CPP =# make's own is a command, and never empty

# Refuse unknown commands and options at once: `make autorace SEDS=3` would otherwise drive the default ten seeds.
ifneq ($(MAKECMDGOALS),)
ifeq ($(MAKELEVEL),0)
strangers := $(filter-out $(verbs),$(MAKECMDGOALS))
quoted = '$(subst ','\'',$1)'# one word of the shell's, whatever is in it
$(if $(strangers),$(error $(shell scripts/help.sh --no-command $(foreach word,$(strangers),$(call quoted,$(word))))))
rules := $(shell awk -v RS= '{ for (i = 1; i <= split("$(MAKECMDGOALS)", verb, " "); i++) if ($$1 == verb[i] ":") print }' Makefile)
rules += $(if $(findstring $$(WHERE),$(rules)),$(value WHERE))
given := $(foreach name,$(.VARIABLES),$(if $(filter command,$(origin $(name))),$(name)))
unknown := $(strip $(foreach name,$(filter-out MIRROR,$(given)),$(if $(findstring $$($(name)),$(rules)),,$(name))))
# As typed: make would take a $ in them for a variable of its own.
$(foreach name,$(given),$(eval override $(name) := $$(value $(name))))
export $(given)
$(if $(unknown),$(error $(shell scripts/help.sh --no-option "$(MAKECMDGOALS)" $(foreach word,$(unknown),$(call quoted,$(word)=)))))
switches := $(foreach name,BASHRC CONTROL CPP FAST FILM PEOPLE QUICK RESUME,$(if $(findstring $$($(name)),$(rules)),$(name)))
undecided := $(strip $(foreach name,$(switches),$(if $(filter-out 0 1 no yes false true,$(value $(name)))$(word 2,$(value $(name))),$(call quoted,$(name)=$($(name))))))
$(if $(undecided),$(error $(shell scripts/help.sh --no-switch $(undecided))))
numbers := CROSSINGS DURATION GOALS HOURS JOBS KIDNAPS LAPS MEMORY_S MINUTES PACE REPEATS ROUNDS SAMPLE SEED SEEDS STARTS TRACKS WORKERS YARDS
numbers := $(foreach name,$(numbers),$(if $(findstring $$($(name)),$(rules)),$(if $($(name)),$(call quoted,$(name)=$($(name))))))
wrong := $(if $(strip $(numbers)),$(shell scripts/help.sh --no-number "$(MAKECMDGOALS)" $(numbers)))
$(if $(wrong),$(error $(wrong)))
endif
endif

setup: ## install what is missing, and build [BASHRC=1: and in ~/.bashrc source it in each new terminal] [MIRROR=cn]
	@scripts/setup.sh $(if $(filter-out 0 no false,$(BASHRC)),--bashrc)

course: ## drive the line course by camera, and report [LAPS=1] [DURATION=s] [FOLLOWER=06follower_pid.py] [FAST=1] [CAMERA=640x480] [SEED=0]
	@scripts/course.sh $(if $(LAPS),--laps "$$LAPS") $(if $(DURATION),--duration "$$DURATION") \
	  $(if $(FOLLOWER),--follower "$$FOLLOWER") $(if $(filter-out 0 no false,$(FAST)),--fast) \
	  $(if $(CAMERA),--camera "$$CAMERA") $(if $(SEED),--seed "$$SEED")

race: ## drive the racetrack by camera, and report [LAPS= DURATION= FAST= CAMERA= SEED= FOLLOWER=lane_follow_p.py]
	@scripts/course.sh --course race $(if $(LAPS),--laps "$$LAPS") \
	  $(if $(DURATION),--duration "$$DURATION") $(if $(FOLLOWER),--follower "$$FOLLOWER") \
	  $(if $(filter-out 0 no false,$(FAST)),--fast) $(if $(CAMERA),--camera "$$CAMERA") \
	  $(if $(SEED),--seed "$$SEED")

replay: ## go back to an image of a run by FAST=1, and drive on from there [RUN=out/course] [AT=lost: or lap, contact, largest, 23.4, image:700, end] [CONTROL=1] [PORT=8080] [OUT=out/replay]
	@scripts/replay.sh $(if $(RUN),--run "$$RUN") $(if $(AT),--at "$$AT") \
	  $(if $(filter-out 0 no false,$(CONTROL)),--control) $(if $(PORT),--port "$$PORT") $(if $(OUT),--out "$$OUT")

viewer: ## start the line course, and show it in the browser [CONTROL=1] [RVIZ=FILE] [PORT=8080] [ADDRESS=0.0.0.0]
	@exec scripts/viewer.sh $(if $(filter-out 0 no false,$(CONTROL)),control:=true) \
	  $(if $(PORT),"port:=$$PORT") $(if $(ADDRESS),"address:=$$ADDRESS") $(if $(RVIZ),"rviz:=$$RVIZ")

lab: ## lessons, editor, terminals and the world in one browser window [WS=~/courses_ws] [PORT=8888]
	@exec scripts/lab.sh $(if $(WS),--ws "$$WS") $(if $(PORT),--port "$$PORT")

drive: ## drive the racecar with the keys W, A, S and D, in a window or in this terminal
	@scripts/drive.sh

lane: ## keep the lane by camera, stop for people, and report [METHOD=sliding_windows LAPS= DURATION= FAST= SEED= PEOPLE=1]
	@scripts/lane.sh $(if $(METHOD),--method "$$METHOD") $(if $(LAPS),--laps "$$LAPS") \
	  $(if $(DURATION),--duration "$$DURATION") $(if $(filter-out 0 no false,$(FAST)),--fast) \
	  $(if $(SEED),--seed "$$SEED") $(if $(filter 0 no false,$(PEOPLE)),--empty)

track: ## follow the red cylinder by camera, and report [SCENE=moving SEED= TRACKER=visual_tracker_pid.py FAST=1]
	@scripts/track.sh $(if $(SCENE),--scene "$$SCENE") $(if $(SEED),--seed "$$SEED") \
	  $(if $(TRACKER),--tracker "$$TRACKER") $(if $(filter-out 0 no false,$(FAST)),--fast)

avoid: ## drive by laser through halls with columns, and report [SEEDS=20] [WORKERS=1]
	@scripts/avoid.sh $(if $(SEEDS),--seeds "$$SEEDS") $(WHERE)

navigate: ## map the house, localise, drive to goals, and report [GOALS=5] [SEED=0] [PACE=1] [MAP=out/navigate/map.yaml]
	@scripts/navigate.sh $(if $(GOALS),--goals "$$GOALS") $(if $(SEED),--seed "$$SEED") \
	  $(if $(PACE),--real-time-factor "$$PACE") $(if $(MAP),--map "$$MAP")

autorace: ## drive the missions of AutoRace 2020, and score each [SEEDS=10] [MISSION=all] [WORKERS=1]
	@scripts/autorace.sh $(if $(SEEDS),--seeds "$$SEEDS") $(if $(MISSION),--mission "$$MISSION") $(WHERE)

mark: ## drive each submission in a sandbox, and mark it SUBMISSIONS=DIR [COURSE=course SEEDS=3 RULES=YAML FILM=1 RESUME=1 OUT=DIR WORKERS=1]
	@scripts/mark.sh $(if $(SUBMISSIONS),--submissions "$$SUBMISSIONS") $(if $(COURSE),--course "$$COURSE") \
	  $(if $(SEEDS),--seeds "$$SEEDS") $(if $(RULES),--rules "$$RULES") \
	  $(if $(filter-out 0 no false,$(FILM)),--film) $(if $(filter-out 0 no false,$(RESUME)),--resume) \
	  $(if $(OUT),--out "$$OUT") $(WHERE)

grade: ## drive one program as mark does: passed or not, and why, also for CI FILE=follower.py [COURSE=course SEEDS=3 RULES=YAML FILM=1 OUT=DIR]
	@scripts/grade.sh $(if $(FILE),--file "$$FILE") $(if $(COURSE),--course "$$COURSE") \
	  $(if $(SEEDS),--seeds "$$SEEDS") $(if $(RULES),--rules "$$RULES") \
	  $(if $(filter-out 0 no false,$(FILM)),--film) $(if $(OUT),--out "$$OUT")

site: ## all pages with a search, in English and Chinese, for the browser: out/site/index.html
	@scripts/site.sh

shell: ## a terminal in which the lessons' commands work, also on a Linux that is not Debian
	@scripts/shell.sh

deps: ## install the Debian packages that a workspace depends on [WS=~/catkin_ws]
	@scripts/deps.sh $(if $(WS),"$$WS")

build: ## rebuild the workspace [CPP=1: with the lessons' C++ programs]
	@scripts/setup.sh --build $(if $(filter-out 0 no false,$(CPP)),--cpp)

report: ## write out/report.txt for a bug report: versions, this machine, which errors the last logs have
	@scripts/report.sh

clean: ## remove what was installed and built here (out/ stays, except out/test/)
	@scripts/clean.sh

clean-root: ## remove the Debian that a Linux which is not Debian has for this
	@scripts/debian_root.sh --remove

help: ## list the commands
	@scripts/help.sh

# For those who test or change this repository.

test: ### run all checks and tests [JOBS=3], or in a minute the core's quick ones, and those of changed packages [FAST=1]
	@scripts/test.sh $(if $(JOBS),--jobs "$$JOBS") $(if $(filter-out 0 no false,$(FAST)),--fast)

lint: ### check the style of the Python code, with ruff
	@scripts/lint.sh

race-trials: ### drive many laps with disturbances, by lane_follow and by plain P [SEEDS=20] [TRACKS=10] [WORKERS=1]
	@scripts/race_trials.sh $(if $(SEEDS),--seeds "$$SEEDS") $(if $(TRACKS),--tracks "$$TRACKS") $(WHERE)

track-trials: ### follow cylinders that stand, move or are hidden, in many runs [SEEDS=20] [WORKERS=1]
	@scripts/track_trials.sh $(if $(SEEDS),--seeds "$$SEEDS") $(WHERE)

lane-trials: ### test lane keeping in varying light and with people crossing [SEEDS=20] [CROSSINGS=100] [METHOD=sliding_windows] [WORKERS=1]
	@scripts/lane_trials.sh $(if $(SEEDS),--seeds "$$SEEDS") $(if $(CROSSINGS),--crossings "$$CROSSINGS") \
	  $(if $(METHOD),--method "$$METHOD") $(WHERE)

navigation-trials: ### test move_base in narrow worlds and with people crossing [YARDS=50] [REPEATS=2] [CROSSINGS=20] [PACE=1] [WORKERS=1]
	@scripts/navigation_trials.sh $(if $(YARDS),--yards "$$YARDS") $(if $(REPEATS),--repeats "$$REPEATS") \
	  $(if $(CROSSINGS),--crossings "$$CROSSINGS") $(if $(PACE),--real-time-factor "$$PACE") \
	  $(WHERE)

localisation-trials: ### test amcl: global localisation, kidnapped robot, tracking [STARTS=20] [KIDNAPS=10] [SEED=0] [PACE=1] [WORKERS=1]
	@scripts/localisation_trials.sh $(if $(STARTS),--starts "$$STARTS") \
	  $(if $(KIDNAPS),--kidnaps "$$KIDNAPS") $(if $(SEED),--seed "$$SEED") \
	  $(if $(PACE),--real-time-factor "$$PACE") $(WHERE)

bench-lanes: ### compare all lane detection methods [SEEDS=5] [WORKERS=1]
	@scripts/bench_lanes.sh $(if $(SEEDS),--seeds "$$SEEDS") $(WHERE)

bench: ### run the benchmarks, and write out/bench/ [ONLY=renderer,step] [QUICK=1] [MEMORY_S=30000]
	@scripts/bench.sh $(if $(ONLY),--only "$$ONLY") $(if $(filter-out 0 no false,$(QUICK)),--quick) \
	  $(if $(MEMORY_S),--memory-s "$$MEMORY_S")

fuzz: ### fuzz testing with malformed files, requests and messages [MINUTES=10] [TARGET=urdf] [SEED=n], or repeat one input [INPUT=out/fuzz/…]
	@scripts/fuzz.sh $(if $(MINUTES),--minutes "$$MINUTES") $(if $(TARGET),--target "$$TARGET") \
	  $(if $(SEED),--seed "$$SEED") $(if $(INPUT),--input "$$INPUT")

chaos: ### kill, stop, starve or restart processes during a drive, at random times [ROUNDS=20] [SEED=1] [COURSE=course|race|lane_empty] [ONLY=kill]
	@scripts/chaos.sh $(if $(ROUNDS),--rounds "$$ROUNDS") $(if $(SEED),--seed "$$SEED") \
	  $(if $(COURSE),--course "$$COURSE") $(if $(ONLY),--only "$$ONLY")

soak: ### run a course for hours with user activity, and look for leaks [HOURS=4] [COURSE=course|race|navigation]
	@scripts/soak.sh $(if $(HOURS),--hours "$$HOURS") $(if $(COURSE),--course "$$COURSE")

mutants: ### mutation testing of the core: how many small code changes do its tests detect? [SAMPLE=1000] [SEED=1]
	@scripts/mutants.sh $(if $(SAMPLE),--sample "$$SAMPLE") $(if $(SEED),--seed "$$SEED")

check-releases: ### which of our Debian packages another release lacks, and which changed there [RELEASE=testing]
	@scripts/check_releases.sh $(if $(RELEASE),"$$RELEASE")

deb: ### build a Debian package of everything, in out/
	@scripts/deb.sh

image: ### build the image of docker/, and save it in out/, for docker load [SUITE=bookworm]
	@scripts/image.sh $(if $(SUITE),--suite "$$SUITE")

wheels: ### build Python packages of the simulator and the learning environments, in out/wheels/, for pip
	@scripts/wheels.sh
