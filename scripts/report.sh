#!/usr/bin/env bash
# Writes out/report.txt, which a bug report wants: our version, this machine, how far setup came, what went wrong last.
#
# Of a setting it has one of some known values, and of a log the errors of Python, ROS and ours, and the places in our
# files and in Debian's, as all else may name people, machines or passwords. What `make mark` wrote is not read.
on_any_linux=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
state=$root/.setup venv=$root/.venv tests=no
lines=20  # of each verb's errors, the last
ours=$(sed -n '/^OUR_FOLDERS/,/)/p' "$root/scripts/own_packages.py" | grep -o '"[a-z_]*"' | tr -d '"' | paste -sd '|')

learners="learning_topic|exercises|lessons"  # where learners add files of their own
python=$(python3 -c 'import builtins as b; print(*(n for n in dir(b) if n.endswith(("Error", "Exception"))), sep="|")' 2> /dev/null || echo Exception)
modules='rospy|ros\w*|genpy|genmsg|actionlib|tf2?|tf2_ros|xacro|catkin\w*|cv_bridge|numpy|yaml|xml|json|subprocess|xmlrpc|http'
modules+="|bullet_sim\w*|sim_viewer|evaluation|marking|run_session|workspace_needs|node_basics|nav_algorithms"
libraries='cv2|numpy|numba|llvmlite|pybullet\w*|moderngl|onnxruntime|scipy|psutil|yaml'

# One of these values, or that it is another one.
known() {
  local value=$1 each
  for each in "" "${@:2}"; do [[ $value != $each ]] || { echo "${value:-not set}"; return; }; done
  echo another
}
# What setup would still do, as it finds out itself; each line begins with the subject.
how_far_setup_came() {
  local told file
  is_served || { say "setup: in a Debian of its own, which is $([ -e /var/lib/ros1-driving-courses/complete ] && echo there || echo missing)"; return; }
  (check_machine) 2>/dev/null || { say "setup: not for this machine or folder; make setup says why"; return; }
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
# The errors in the logs of a folder or file, under this heading.
errors() {
  local heading=$1 logs=() found
  mapfile -td '' logs < <(find -H "${@:2}" -name '*.log' -size +0 -printf '%T@ %p\0' 2>/dev/null | sort -zn | cut -zd ' ' -f 2-)
  [ ${#logs[@]} -gt 0 ] || return 0
  found=$(ROOT=$root OURS=$ours PYTHON=$python MODULES=$modules LIBRARIES=$libraries LEARNERS=$learners \
    perl -ne '
    BEGIN { open my $files, "<&=3"; %tracked = map { chomp; $_ => 1 } <$files> }
    while (m{(?:\Q$ENV{ROOT}\E/(?=(?:src/(?:$ENV{OURS})|scripts|test|\.venv)/)|(?<![\w./-])(?=/usr/lib/python3[\d.]*/))
             ((?:(?!\.\./)[\w./+-])+)(?:",\ line\ |:)(\d+)
            |^(?:(?:$ENV{MODULES})\.(?:\w+\.)*(\w+(?:Error|Exception))|($ENV{PYTHON}))(?::|$)
            |(process\ has\ died|exit\ code\ -?\d+|CMake\ Error|[Nn]o\ space\ left|Permission\ denied|Segmentation\ fault
             |Unable\ to\ locate\ package|unmet\ dependencies|No\ matching\ distribution|DO\ NOT\ MATCH\ THE\ HASHES
             |Temporary\ failure|Could\ not\ (?:resolve|connect|get\ lock)|Connection\ refused|Network\ is\ unreachable)}gx) {
      my ($place, $line, $known) = ($1, $2, $3 // $4 // $5);
      # a learner may put files of his own there
      $place =~ s{^src/\w+/\K.*}{} if $place and !$tracked{$place} and
        (%tracked or $place =~ m{^src/(?:(?:$ENV{LEARNERS})/|.*/scripts/)});
      $place =~ s{/site-packages/\K(?!(?:$ENV{LIBRARIES})/).*}{} if $place;
      print "  ", $known // "$place:$line", "\n";
    }' "${logs[@]}" 3< <(git -C "$root" ls-files src 2>/dev/null) | uniq | tail -n "$lines")
  say "log: $heading, $(date -r "${logs[-1]}" '+%F %R'):${found:+$'\n'}${found:- no known error}"
}
report() (
  export LC_ALL=C LANGUAGE=  # whoever answers may not read the reporter's language
  for part in machine debian python; do . "$root/scripts/setup/$part.sh"; done
  say "ros1-driving-courses $(our_version), commit $(git -C "$root" describe --always --dirty --exclude='*' 2>/dev/null || echo unknown)"
  say "system: $(. /etc/os-release; echo "$PRETTY_NAME"), $(dpkg --print-architecture 2>/dev/null || uname -m), $(uname -sr)$([ ! -e /.dockerenv ] || echo ', in Docker')"
  say "processor: $(nproc) cores, $(lscpu | sed -n 's/^Model name: *//p' | head -n 1)"
  awk '/^(MemTotal|MemAvailable|SwapTotal):/ {printf "memory: %s %d MB\n", $1, $2 / 1024}' /proc/meminfo
  say "disk: $(df -Pm "$root" | awk 'NR == 2 {print $4}') MB free"
  say "setting: LANG $(known "${LANG:-}" POSIX '@([a-z][a-z]_[A-Z][A-Z]|C)?(.[Uu][Tt][Ff]?(-)8)')"
  say "setting: TURTLEBOT3_MODEL $(known "${TURTLEBOT3_MODEL:-}" burger waffle waffle_pi)"
  say "setting: ROS_MASTER_URI $(known "${given_master[0]}" 'http://@(localhost|127.0.0.1):+([0-9])?(/)')"
  say "setting: ROS_HOSTNAME $(known "${given_master[1]}" localhost), ROS_IP $(known "${given_master[2]}" 127.0.0.1)"
  how_far_setup_came
  versions
  errors setup "$state" -maxdepth 1
  for verb in course race lane lane_empty track avoid navigate autorace; do errors "make $verb" "$root/out/$verb"; done
  for verb in viewer drive; do errors "make $verb" "$root/out/$verb.log"; done
  errors roslaunch "${HOME:-/nonexistent}/.ros/log/latest" "$state/ros/log/latest"
)
text=$(report)
reason=$({ mkdir -p "$root/out" && printf '%s\n' "$text" >"$root/out/report.txt"; } 2>&1) ||
  fail $"out/report.txt cannot be written: ${reason##*: }. Free some disk space, or make out/ a folder of yours"
say $"out/report.txt is written. Read it, then attach it to your report."
