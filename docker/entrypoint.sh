#!/usr/bin/env bash
# Runs a command in the built workspace, as the owner of its source. Changes no file's owner.
#
# compose.yaml mounts the repository's folders over the image's, and the whole of it, to read, at $repository.
set -euo pipefail
ws=/home/learner/ws repository=/repository
fail() { printf 'docker: %s\n' "$1" >&2; exit 2; }

if [ "$(id -u)" = 0 ]; then
  IFS=: read -r user group < <(stat -L -c %u:%g "$ws/src")
  if [ "$user" != 0 ]; then
    getent passwd "$user" >/dev/null ||
      sed -i "s/^learner:x:[0-9]*:[0-9]*:/learner:x:$user:$group:/" /etc/passwd 2>/dev/null || true
    exec setpriv --reuid "$user" --regid "$group" --clear-groups -- "$0" "$@"
  fi
fi
# Where a user has no entry in /etc/passwd, or another's home, programs ask these.
[ -w "${HOME:-/nowhere}" ] || HOME=$(mktemp -d 2>/dev/null) || fail "there is no folder to write to: run with a writable /tmp"
USER=$(id -un 2>/dev/null) || USER=learner
export HOME USER LOGNAME=$USER ROS_HOSTNAME=localhost

cd "$ws"
if [ -d "$repository" ]; then
  changed=$({ diff <("$ws/docker/lists.sh" "$repository") /usr/local/share/workspace-lists || true; } | awk '/^[<>]/ && !name {name = $3} END {print name}')
  [ -z "$changed" ] ||
    fail "$changed is not what this image was made from; type: docker compose -f docker/compose.yaml build"
  find "$repository" -maxdepth 1 -type f -readable -size -1024k -exec cp --remove-destination -t . {} + 2>/dev/null ||
    fail "user $(id -u) cannot write in $ws: run the container with a writable file system"
fi
mkdir -p out 2>/dev/null || true
[ -w out ] || fail "out/ belongs to $(stat -c 'user %u' out), not to you; type: sudo chown -R $(id -u):$(id -g) out"
# The build is the image's, the source the host's, where git ignores what a build makes of it.
models=src/sim/bullet_sim/src/bullet_sim/props.py
[ ! -f "$models" ] || python3 "$models" || fail "user $(id -u) cannot write in src/sim/bullet_sim"
worlds=src/compat/turtlebot3_gazebo
[ ! -f src/compat/names.yaml ] || told=$(.venv/bin/python3 -B tools/makers name_packages 2>&1 >/dev/null) || fail "${told##*$'\n'}"
[ ! -d "$worlds" ] || told=$(.venv/bin/python3 -B tools/makers turtlebot3_worlds 2>&1 >/dev/null) || fail "$worlds: ${told##*$'\n'}"
set +u
. devel/setup.bash
exec "$@"
