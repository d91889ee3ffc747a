#!/usr/bin/env bash
# Writes out/report.txt, which a bug report wants: our version, this machine, how far setup came, the ends of the last logs.
#
# Nothing personal: home folder, user, host, addresses and passwords in addresses are replaced.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
state=$root/.setup venv=$root/.venv tests=no
newest=8 lines=30  # logs, and the lines of each

# What setup would still do, as it finds out itself; each line begins with the subject.
how_far_setup_came() {
  local told file
  told=$(check_machine 2>&1) || { say "setup: ${told#*: }"; return; }
  check_machine
  told=$(missing_packages | xargs)
  say "setup: Debian's packages: ${told:+missing: }${told:-all there}"
  for file in requirements requirements-source requirements-rosdep; do
    [ ! -f "$lists/$file.txt" ] || cmp -s "$lists/$file.txt" "$state/$file.txt" || told=unfinished
  done
  if ! venv_is_sound; then told="none that is sound"; elif [ "$told" != unfinished ]; then told=complete; fi
  say "setup: Python environment: $told"
  if [ -e "$state/build-unfinished" ]; then told=unfinished; elif [ -f "$root/devel/setup.bash" ]; then told=done; else told=none; fi
  say "setup: build: $told"
}
versions() {
  dpkg-query -W -f 'version: ${Package} ${Version}\n' python3 python3-rospy libgl1-mesa-dri ros-courses 2>/dev/null | grep ' .* ' || true
  for found in "$venv"/lib/python3*/site-packages/{pybullet,opencv_python_headless,moderngl,numpy,numba,onnxruntime}-*.dist-info; do
    [ ! -d "$found" ] || say "version: $(basename "$found" .dist-info)"
  done
}
last_logs() {
  { find "$state" -maxdepth 1 -name '*.log' -size +0 -printf '%T@ %p\n'
    find -L "$root/out" "${HOME:-/nonexistent}/.ros/log/latest" "$state/ros/log/latest" -name '*.log' -size +0 -printf '%T@ %p\n'
  } 2>/dev/null | sort -rn | head -n "$newest" | cut -d ' ' -f 2- || true
}
report() (
  export LC_ALL=C LANGUAGE=  # whoever answers may not read the reporter's language
  for part in machine debian python; do . "$root/scripts/setup/$part.sh"; done
  say "ros1-driving-courses $(our_version), commit $(git -C "$root" describe --always --dirty --exclude='*' 2>/dev/null || echo unknown)"
  say "system: $(. /etc/os-release; echo "$PRETTY_NAME"), $(dpkg --print-architecture 2>/dev/null || uname -m), $(uname -sr)$([ ! -e /.dockerenv ] || echo ', in Docker')"
  say "processor: $(nproc) cores, $(lscpu | sed -n 's/^Model name: *//p' | head -n 1)"
  awk '/^(MemTotal|MemAvailable|SwapTotal):/ {printf "memory: %s %d MB\n", $1, $2 / 1024}' /proc/meminfo
  say "disk: $(df -Pm "$root" | awk 'NR == 2 {print $4}') MB free at $root"
  say "variables: LANG=${LANG:-} TURTLEBOT3_MODEL=${TURTLEBOT3_MODEL:-} ROS_MASTER_URI=${given_master[0]}"
  how_far_setup_came
  versions
  last_logs | while read -r log; do printf '\n== %s\n' "$log"; tail -n "$lines" "$log"; done
)
# Whole words only: somebody called li has files in /lib.
impersonal() {
  local user
  user=$(id -un 2>/dev/null || id -u)
  HOMES="${HOME:-}:$(getent passwd "$user" | cut -d : -f 6)" HOSTS="${HOSTNAME:-}:$(uname -n)" \
    USERS="$user:${USER:-}:${SUDO_USER:-}:$(getent passwd "$user" | cut -d : -f 5 | cut -d , -f 1)" perl -pe '
    BEGIN {
      sub words { sort { length $b <=> length $a } grep { length && !/^(root|localhost|\/)$/ } @_ }
      @homes = words(split /:/, $ENV{HOMES});
      @hosts = words(map { $_, /^([^.]+)\./ } split /:/, $ENV{HOSTS});
      @users = words(split /:/, $ENV{USERS});
    }
    s/\e\[[\d;?]*[A-Za-z]//g;
    s{://[^\s/@]+@}{://}g;
    s/\b(token|password)=[^\s&]+/$1=.../gi;
    s/[\w.+-]+@[\w-]+(\.[\w-]+)+/address/g;
    for my $name (@homes) { s/\Q$name\E(?![\w-])/~/g }
    for my $name (@hosts) { s/(?<![A-Za-z0-9])\Q$name\E(?![A-Za-z0-9])/host/gi }
    for my $name (@users) { s/(?<![A-Za-z0-9])\Q$name\E(?![A-Za-z0-9])/user/gi }
    s{/home/[^/\s:"\x27]+}{~user}g;
    s{[/\\]Users[/\\](?:[^/\\:\n]+(?=[/\\])|[^/\\\s:]+)}{~user}g;
    s/(?<![\w.=-])(?!127\.|0\.0\.0\.0)\d{1,3}(?:\.\d{1,3}){3}(?![\w.])/address/g;
    s/\[(?:[0-9a-f]*:){3,}[0-9a-f]*\]/[address]/gi;
    s/^(.{400}).+/$1 .../'
}
mkdir -p "$root/out"
report 2>&1 | impersonal >"$root/out/report.txt"
say $"out/report.txt is written. Read it, then attach it to your report."
