# Steps 3 and 4: the Python environment and its packages.

venv_is_sound() {
  [ ! -e "$state/venv-unfinished" ] && [ -x "$venv/bin/pip" ] &&
    [ "$(cat "$state/venv" 2>/dev/null || echo "$venv $platform")" = "$venv $platform" ] &&
    grep -q '^include-system-site-packages = true' "$venv/pyvenv.cfg" && grep -q '^home = /usr/bin$' "$venv/pyvenv.cfg" &&
    "$venv/bin/python3" -c 'import os, sys, sysconfig; sys.exit(not os.path.isdir(sysconfig.get_path("purelib")))' 2>/dev/null
}
python_environment() {
  ! venv_is_sound || return 0
  step 3 $"making the Python environment .venv"
  rm -rf "$venv" "$state"/requirements* "$state/build-inputs"
  touch "$state/venv-unfinished"
  logged venv /usr/bin/python3 -m venv --system-site-packages "$venv" || fail_with_log $"python3 -m venv failed" venv
  echo "$venv $platform" >"$state/venv"
}

pip() { env -u PIP_USER -u PIP_TARGET -u PIP_PREFIX "$venv/bin/python3" -I -m pip "$@" --no-input --disable-pip-version-check --no-deps; }
pip_failed() {
  # pip downloads all before it installs any, so that the environment is as it was.
  ! network_failed pip || { rm -f "$state/venv-unfinished"; fail $"no network: pip cannot reach its package index (.setup/pip.log says more); connect and run this again"; }
  fail_with_log $"pip $1 failed" pip
}
python_packages() {
  local file target
  for file in requirements.txt requirements-source.txt requirements-rosdep.txt \
    $([ "$tests" = no ] || echo requirements-test.txt) \
    $([ "$workers" = no ] || echo requirements-workers.txt) \
    $([ "$learning" = no ] || echo requirements-learning.txt) \
    $([ "$debugging" = no ] || echo requirements-debugging.txt) \
    $([ "$site" = no ] || echo requirements-site.txt) \
    $([ "$lab" = no ] || echo requirements-lab.txt) \
    $([ "$wheels" = no ] || echo requirements-wheels.txt); do
    [ -f "$lists/$file" ] && ! cmp -s "$lists/$file" "$state/$file" || continue
    touch "$state/venv-unfinished"
    if [ "$file" = requirements-source.txt ]; then
      source_packages
    else
      step 4 $"installing the Python packages of ${lists#"$root"/}/$file"
      target=(--no-user)
      case $file in requirements-rosdep.txt | requirements-wheels.txt)
        target=(--target "$venv/$(basename "${file#requirements-}" .txt)" --upgrade) ;;
      esac
      logged pip pip install "${target[@]}" --require-hashes --only-binary :all: -r "$lists/$file" || pip_failed install
    fi
    cp "$lists/$file" "$state/$file"
  done
  rm -f "$state/venv-unfinished"
}
