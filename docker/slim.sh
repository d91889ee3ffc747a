#!/usr/bin/env bash
# Takes out of an image what nobody uses there: symbols and sample models of PyBullet, other packages' own tests, manuals.
set -euo pipefail
shopt -s nullglob
cd .venv/lib/python3*/site-packages
strip --strip-unneeded pybullet.*.so eglRenderer.*.so
rm -rf pybullet_data pybullet_envs pybullet_examples pybullet_robots pybullet_utils
for package in numpy scipy numba llvmlite matplotlib; do
  [ ! -d $package ] || find $package -type d -name tests -prune -exec rm -rf {} +
done
rm -rf /usr/share/doc /usr/share/man /usr/share/info /usr/share/locale /usr/share/help
