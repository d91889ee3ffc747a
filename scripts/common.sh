# Sourced first by every script here: the root, one-line messages, and an environment without the caller's Python and ROS.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
self=$(basename "$0" .sh)

# $"..." follows the locale. Chinese is shown on machines, too, whose C library has no data of a Chinese locale: by those of
# C.UTF-8, which glibc looks up under this name, too. Under its own name glibc translates nothing (from 2.39 on).
TEXTDOMAIN=courses-shell TEXTDOMAINDIR=$root/src/interfaces/terminal_language/src/terminal_language/locale
translated() { cat; }  # what a program of ours wrote before devel/ was there
spoken=${LC_ALL:-${LC_MESSAGES:-${LANG:-}}}
case "$spoken" in C | POSIX) spoken= ;; *) spoken=${LANGUAGE:-$spoken} ;; esac
if [[ $spoken == zh* ]]; then
  export LC_ALL=C_CN.UTF-8 LANGUAGE=zh_CN
  translated() { PYTHONPATH=$root/src/interfaces/terminal_language/src python3 -m terminal_language; }
fi

say() { printf '%s\n' "$*"; }
fail() { printf '%s: %s\n' "$self" "$1" >&2; exit "${failure_code:-1}"; }

our_version() { sed -n 's/^__version__ = "\(.*\)".*/\1/p' "$root/src/sim/bullet_sim/src/bullet_sim/__init__.py"; }

# `sudo make course` would leave root's files in a user's folder: continue as that user.
if [ "$(id -u)" = 0 ] && [ -z "${stays_root:-}" ] && [ -n "${SUDO_USER:-}" ] && [ "$(stat -c %U "$root")" = "$SUDO_USER" ]; then
  exec sudo -u "$SUDO_USER" -H -- env ${MIRROR:+"MIRROR=$MIRROR"} ${PIP_INDEX_URL:+"PIP_INDEX_URL=$PIP_INDEX_URL"} "$root/scripts/$(basename "$0")" "$@"
fi

# On a Linux that is none of the Debians in dependencies/ (which an installed package lacks) a Debian of its own runs the script.
is_served() { [ ! -d "$root/dependencies" ] || compgen -G "$root/dependencies/$(. /etc/os-release 2>/dev/null && [ "${ID:-}" = debian ] && echo "${VERSION_CODENAME:-}")-*" >/dev/null; }
[ -n "${on_any_linux:-}" ] || is_served || exec "$root/scripts/debian_root.sh" "$(basename "$0")" "$@"

# The ROS master that the caller set, for scripts that use it.
given_master=("${ROS_MASTER_URI:-}" "${ROS_HOSTNAME:-}" "${ROS_IP:-}")
export CALLERS_ROS_MASTER_URI=${given_master[0]}  # for run_session.master

# Another python3, an active venv or conda, or a sourced ROS workspace must not leak in.
unset "${!PYTHON@}" "${!CONDA_@}" "${!ROS_@}" VIRTUAL_ENV CMAKE_PREFIX_PATH LD_LIBRARY_PATH \
  PKG_CONFIG_PATH MAKEFLAGS MFLAGS MAKELEVEL CC CXX CFLAGS CXXFLAGS BASH_ENV ENV CDPATH
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin

# Sources the workspace, as a learner's terminal does with `source devel/setup.bash`.
enter_workspace() {
  local tried=  # catkin's setup.sh writes there, and ends with a traceback where it cannot
  if ! { tried=$(mktemp /tmp/courses.XXXXXX) && head -c 65536 /dev/zero > "$tried"; } 2> /dev/null; then
    [ -z "$tried" ] || rm -f "$tried"
    fail $"/tmp is full, or cannot be written: make room there, then type this again"
  fi
  rm -f "$tried"
  set +u; . "$root/devel/setup.bash"; set -u
  export ROS_HOSTNAME=localhost  # works where the machine's own name does not resolve
  # roscore and roslaunch write to ~/.ros, and end if they cannot.
  local home=${HOME:-/nonexistent}
  if [ ! -w "$home/.ros" ] && { [ -e "$home/.ros" ] || [ ! -w "$home" ]; }; then export ROS_HOME=$root/.setup/ros; fi
}

# Sends this shell, or what it becomes by exec, a SIGHUP when its terminal closes: of `ssh -t HOST make ...`, make alone gets it.
# A shell with jobs gives each a process group of its own, and tells them itself, but none that was disowned.
end_with_terminal() {
  { : < /dev/tty; } 2> /dev/null || return 0
  setpriv --pdeathsig TERM python3 -c 'import os, select, sys
terminal = select.poll()
terminal.register(0, 0)  # its end alone: keys are read by others
if os.getpgrp() == os.getsid(0):
    terminal.poll()
    os.kill(int(sys.argv[1]), 1)' $$ < /dev/tty > /dev/null 2>&1 &
}

# Refuses a name that the program would refuse after setup, which may take minutes: the name, how the line begins, and the
# known names; without any the program looks.
known() {
  local name=$1 line=$2 each there
  shift 2
  for each in "$@"; do [ "$each" != "$name" ] || return 0; done
  there=$(printf ', %s' "$@")
  [ $# -eq 0 ] || fail "$line ${there#, }"
}
# The words between quotation marks from a file's line with this to one with that.
quoted_words() { sed -n "\|$2|,\|$3|p" "$root/$1" 2> /dev/null | grep -oE '^ *"[a-z_]+"|, "[a-z_]+"' | tr -d ', "'; }
# A key's value in a course's file.
course_key() { sed -n "s/^$2: *\([^ #]*\).*/\1/p" "$root/src/evaluation/courses/$1.yaml" 2> /dev/null; }
followers() {
  local package pattern drives_by
  package=$(course_key "$1" follower_package) pattern=$(course_key "$1" followers) drives_by=$(course_key "$1" drives_by)
  [ -z "$drives_by" ] || (cd "$root"/src/"$package"/"${pattern%/*}" && grep -lF -e "$drives_by" -- ${pattern##*/}) 2> /dev/null
}
# Of lane keeping, the usual one first.
methods() {
  (cd "$root/src/lessons/lane_keeping/src/lane_keeping/methods" && echo sliding_windows &&
    printf '%s\n' [!_]*.py | sed 's/\.py$//' | grep -vx sliding_windows) 2> /dev/null
}

# Sets up what a trial with these arguments needs.
set_up_trial() {
  local options=()
  if [[ " $* " =~ \ --workers[\ =]0*([2-9]|[1-9][0-9]+)\  || " $* " == *" --scheduler"* ]]; then options=(--workers); fi
  "$root/scripts/setup.sh" "${options[@]}" || exit 2
}

# Waits until no other command of this user is between its choice of a master and its simulator's start (take_turn in
# run_session/master.py); $turn is the lock's descriptor.
take_turn() {
  local lock=${TMPDIR:-/tmp}/course_run-$(id -u).lock
  exec {turn}< /dev/null  # where the file cannot be written, or leads elsewhere: without a turn
  [ -L "$lock" ] || { exec {turn}<> "$lock"; } 2> /dev/null || return 0
  if ! flock -n "$turn"; then
    local number= name= words=() age
    read -r number < "$lock" || true
    [[ $number =~ ^[0-9]+$ ]] || number=
    [ -z "$number" ] || { mapfile -d '' -t words < "/proc/$number/cmdline"; } 2> /dev/null || true
    number=${number:-?} name=${words[1]:-?} age=$(($(date +%s) - $(stat -c %Y "$lock")))
    name=${name##*/}
    say $"Waiting: $name (process $number) has been starting its simulator for $age s" >&2
    flock -w 300 "$turn" || return 0
  fi
  printf '%s\n' $$ 2> /dev/null > "$lock" || true  # who holds it, for the others' line; the disk may be full
}

# Waits for the simulator of this process, and ends the turn; fails if the process ends before.
wait_for_simulator() {
  setpriv --pdeathsig TERM python3 -m run_session.master --wait "$1" 2> /dev/null {turn}>&- &
  wait $! || return 1  # in the background: otherwise this shell's traps would wait, too
  exec {turn}>&-
}

# Takes the turn, and chooses a master that other terminals can join: the caller's, else the usual one, or a new one if
# that is another user's. Fails, after a line that says why, if a simulator runs there.
choose_master() {
  take_turn
  local usual=http://localhost:11311
  if [ -n "${given_master[0]}" ] && [ "${given_master[0]%/}" != "$usual" ]; then
    export ROS_MASTER_URI=${given_master[0]}
    if [ -n "${given_master[2]}" ]; then unset ROS_HOSTNAME; export ROS_IP=${given_master[2]}; fi
    if [ -n "${given_master[1]}" ]; then export ROS_HOSTNAME=${given_master[1]}
    # Another machine cannot reach this one as localhost: let rospy use this machine's own name.
    elif [[ ! $ROS_MASTER_URI =~ ^http://(localhost|127\.) ]]; then unset ROS_HOSTNAME; fi
  else
    ROS_MASTER_URI=$(trap '' INT; python3 -m run_session.master) || return 1  # callers' || turns set -e off
    export ROS_MASTER_URI
    [ "$ROS_MASTER_URI" = "$usual" ] ||
      say $"Another ROS master is running on this machine. In each further terminal type: export ROS_MASTER_URI=$ROS_MASTER_URI"
  fi
  (trap '' INT; python3 -m bullet_sim_ros.only_simulator)
}
