#!/usr/bin/env bash
# Lists the Makefile's commands.
#
#   scripts/help.sh
#   scripts/help.sh --no-command WORD          says that make has no such command, and which is meant
#   scripts/help.sh --no-command-of MAKEFILE WORD  the same of another Makefile's commands
#   scripts/help.sh --no-option COMMAND WORD...   the same of an option
#   scripts/help.sh --no-option-of MAKEFILE COMMAND WORD...  the same of another Makefile's
#   scripts/help.sh --no-switch NAME=...       says what these options may be
#   scripts/help.sh --no-number COMMAND NAME=VALUE...  the same of the first that is no number, or 0 where that cannot
#                                                      be, if any; all of these for the Makefiles
#   scripts/help.sh --no-ros                   what to type in a terminal outside of the Debian that has ROS
on_any_linux=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# The Makefile's lines for that mark, in the locale's language: $"..." takes constants, so each is made one.
list() {
  local verb text
  while IFS=$'\t' read -r verb text; do
    eval "text=\$\"$text\""
    printf '  %-20s %s\n' "$verb" "$text"
  done < <(sed -n "s/^\([a-z-]*\):.*[^#]$1 \(.*\)/\1\t\2/p" "$root/Makefile")
}
# The word of a list that is most like another, as a question; nothing if none is.
meant() {
  local near
  near=$(python3 -c 'import difflib, sys; print(*difflib.get_close_matches(sys.argv[1], sys.argv[2:], 1))' "$@" 2>/dev/null) || true
  [ -z "$near" ] || printf $" is %s meant?" "$near"
}
# Says that make has no such command, and which of a Makefile's is meant.
no_command() {
  local verbs
  mapfile -t verbs < <(sed -n 's/^\([a-z-]*\):.*## .*/\1/p' "$1")
  say $"make has no command $2;""$(meant "$2" "${verbs[@]}")"$" \`make\` alone lists them"
}
# The same of an option; after it, the others that were typed.
no_option() {
  local options verb=$2 names=${*:3}
  mapfile -t options < <(sed -n "/^${2%% *}:/,/^$/p" "$1" | grep -oE '\$\([A-Z_]+\)' | tr -d '$()' | sed 's/^WHERE$/WORKERS\nSCHEDULER/' | sort -u)
  say $"make $verb has no option $names;""$(meant "${3%=}" "${options[@]}")"$" \`make\` alone lists the options of each command"
}
case "${1:-}" in
  --no-command)
    lesson=src/lessons/lane_keeping
    if sed -n 's/^\([a-z]*\): ## .*/\1/p' "$root/$lesson/Makefile" | grep -qxF -e "$2"; then
      say $"make $2 is a command of the lesson $lesson; type: make -C $lesson $2"
      exit
    fi
    no_command "$root/Makefile" "$2" ;;
  --no-command-of) no_command "$2" "$3" ;;
  --no-option) no_option "$root/Makefile" "${@:2}" ;;
  --no-option-of) no_option "${@:2}" ;;
  --no-switch) names=${*:2}; say $"$names: write 1 or 0, or leave it out" ;;
  --no-number)
    for given in "${@:3}"; do
      if [[ $given =~ =(-[0-9.]*|[0.]+)$ && "$2 $given" =~ \ (DURATION|GOALS|LAPS|PACE|WORKERS)=|^(avoid|autorace)\ SEEDS= ]]; then
        say $"$given: write a number above 0, or leave it out"; break
      fi
      case $given in
        DURATION=* | HOURS=* | MEMORY_S=* | MINUTES=* | PACE=*)
          [[ $given =~ ^[A-Z_]+=[0-9]+(\.[0-9]+)?$ ]] || { say $"$given: write a number, such as 2 or 0.5, or leave it out"; break; } ;;
        *) [[ $given =~ ^[A-Z_]+=[0-9]+$ ]] || { say $"$given: write a whole number, or leave it out"; break; } ;;
      esac
    done ;;
  --no-ros)
    echo $"This terminal has no ROS. One that has: make -sC $root shell" >&2 ;;
  *)
    version=$(our_version)
    echo $"ROS 1 driving courses, version $version"
    echo $"usage: make COMMAND [OPTION=VALUE ...]"
    list '##'
    echo $"For those who test or change this repository:"
    list '###'
    if is_served; then echo $"Then, in each new terminal: source devel/setup.bash"; else echo $"Then, in each new terminal: make shell"; fi ;;
esac
