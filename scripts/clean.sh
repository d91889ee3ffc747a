#!/usr/bin/env bash
# Removes what setup, build and tests made in this folder; the rest of out/ and Debian's packages stay.
on_any_linux=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"
say $"Removing .venv, build, devel and what else was installed and built here; make setup brings it back, by the network."
rm -rf .venv .setup build devel install out/test .pytest_cache .ruff_cache .catkin_workspace __pycache__
rm -rf src/sim/bullet_sim/src/bullet_sim/data/models src/compat/turtlebot3_gazebo/worlds src/{compat,navigation}/names
for model in src/compat/turtlebot3_gazebo/models/*; do [ "${model##*/}" = turtlebot3_world ] || rm -rf "$model"; done
[ ! -L src/CMakeLists.txt ] || rm -f src/CMakeLists.txt
find src test scripts tools -name __pycache__ -type d -prune -exec rm -rf {} +
