#!/usr/bin/env bash
# Takes out of an image what nobody uses there: PyBullet's symbols, packages' own tests, manuals, libraries to link statically.
set -euo pipefail
shopt -s nullglob
cd .venv/lib/python3*/site-packages
strip --strip-unneeded pybullet.*.so eglRenderer.*.so
rm -rf pybullet_envs pybullet_examples pybullet_robots
for package in numpy scipy numba llvmlite matplotlib; do
  [ ! -d $package ] || find $package -type d -name tests -prune -exec rm -rf {} +
done
rm -rf /usr/share/doc /usr/share/man /usr/share/info /usr/share/locale /usr/share/help
rm -f /usr/lib/*/libboost_*.a /usr/lib/*/libicu*.a /usr/lib/*/libpython3*.a
