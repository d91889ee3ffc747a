#!/usr/bin/env bash
# Builds wheels and source packages of the simulator's core and of the learning environments, in out/wheels/.
#
# Two builds of a commit are equal to the byte: setuptools has one version, and all files have the commit's time. With
# SOURCE_DATE_EPOCH=SECONDS they have that time. src/driving_courses/README.md says how they are installed.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$root"
[ -n "${SOURCE_DATE_EPOCH:-}" ] || SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null) ||
  fail $"git does not know this folder's commit: wheels are built in a clone"
[[ $SOURCE_DATE_EPOCH =~ ^[0-9]{1,10}$ ]] && ((10#$SOURCE_DATE_EPOCH < 1 << 32)) ||
  fail $"SOURCE_DATE_EPOCH is $SOURCE_DATE_EPOCH: write whole seconds since 1970, or leave it out"
"$root/scripts/setup.sh" --wheels --dependencies
export SOURCE_DATE_EPOCH
PYTHONPATH=$root/.venv/wheels .venv/bin/python3 scripts/build_wheels.py out/wheels
count=$(ls out/wheels/*.whl | wc -l)
say $"out/wheels: $count wheels, and the same as source packages, made in ${SECONDS} s. Next: pip install out/wheels/*.whl"
