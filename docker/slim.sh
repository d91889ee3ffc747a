#!/usr/bin/env bash
# Takes out of an image what nobody uses there: symbols, sample data, packages' own tests, manuals, icons, GDAL's map
# projections, libraries to link statically, GCC's sanitizers and link-time optimiser, and ROCm (MPI's plugin for AMD
# accelerators pulls it in, with an LLVM of its own).
set -euo pipefail
shopt -s nullglob
cd .venv/lib/python3*/site-packages
strip --strip-unneeded pybullet.*.so eglRenderer.*.so llvmlite/binding/libllvmlite.so
rm -rf pybullet_envs pybullet_examples pybullet_robots
find pybullet_data -type f ! -name '*.urdf' ! -name '*.py' -delete  # the core's tests read the URDF files
for package in numpy scipy numba llvmlite matplotlib dask distributed; do
  [ ! -d $package ] || find $package -type d -name tests -prune -exec rm -rf {} +
done
rm -rf /usr/share/doc /usr/share/man /usr/share/info /usr/share/locale /usr/share/help /usr/share/icons /usr/share/proj \
  /usr/share/cmake-*/Help
rm -f /usr/lib/*/libboost_*.a /usr/lib/*/libicu*.a /usr/lib/*/libpython3*.a /usr/lib/python3*/config-*/*.a
rm -f /usr/bin/*-lto-dump-* /usr/libexec/gcc/*/*/lto1 /usr/lib/gcc/*/*/lto1 \
  /usr/lib/*/lib{a,hwa,l,t}san.so* /usr/lib/gcc/*/*/lib{a,hwa,l,t}san.*
for comgr in /usr/lib/*/libamd_comgr.so.*.*; do
  llvm=$(objdump -p "$comgr" | awk '$1 == "NEEDED" && $2 ~ /^libLLVM-/ {print $2}')
  [ -z "$llvm" ] || rm -f "${comgr%/*}/${llvm%%.so*}.so"*
done
rm -f /usr/lib/*/libamd_comgr.so* /usr/lib/*/libamdhip64.so* /usr/lib/*/libhsa-runtime64.so* /usr/lib/*/ucx/*rocm*
