#!/usr/bin/env bash
# Gives each command in the image what a terminal has after `source devel/setup.bash`.
set -e
cd /home/learner/ws
mkdir -p out 2>/dev/null || true
[ -w out ] || sudo chown "$(id -u):$(id -g)" out  # a folder that Docker made for a volume is root's
source devel/setup.bash
exec "$@"
