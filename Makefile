# Every verb is a script in scripts/; run a script by itself to see its own exit code.
.PHONY: help course test setup build lint clean

help: ## list the verbs
	@scripts/help.sh

course: ## drive the line course and report [LAPS=1] [DURATION=s] [FOLLOWER=06follower_pid.py]
	@scripts/course.sh $(if $(LAPS),--laps "$(LAPS)") $(if $(DURATION),--duration "$(DURATION)") \
	  $(if $(FOLLOWER),--follower "$(FOLLOWER)")

test: ## run every check and test [JOBS=1]
	@scripts/test.sh $(if $(JOBS),--jobs "$(JOBS)")

setup: ## install what is missing, and build
	@scripts/setup.sh

build: ## build the workspace again
	@scripts/setup.sh --build

lint: ## check the style of the Python code
	@scripts/lint.sh

clean: ## remove what was installed and built here (out/ stays)
	@scripts/clean.sh
