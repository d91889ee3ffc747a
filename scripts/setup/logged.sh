# Commands whose output goes to a log in .setup/, and the messages for their failures.
# Runs a command with its output in a log, and prints every 20 s that it is running (or $doing, if set).
logged() {
  local log=$state/$1.log what=${doing:-$"still running"} beat rc=0
  shift
  (
    trap - EXIT
    while ! read -rt 20 && kill -0 $$ 2>/dev/null; do say $"  $what, after ${SECONDS} s"; done <> <(:)
  ) 9<&- 2>/dev/null &
  beat=$!
  trap 'kill $beat 2>/dev/null' EXIT
  LANGUAGE=en "$@" >"$log" 2>&1 </dev/null || rc=$?  # the messages below look for English words
  kill "$beat" 2>/dev/null
  wait "$beat" 2>/dev/null || true
  trap - EXIT
  return $rc
}

# fail, with the last error line of a log.
fail_with_log() {
  local why log=${state#"$root"/}/$2.log
  why=$(awk '/^CMake Error/ && !cmake {cmake = $0; next} cmake && !told && NF {told = $0} /^E:|^ERROR|[Ee]rror:/ {last = $0}
    END {sub(/^ +/, "", told); print cmake ? cmake " " told : last}' "$state/$2.log")
  fail "$1${why:+: $why} "$"(full log: $log)"
}
# The same for a build: the first cause in the build's output.
fail_with_cause() {
  python3 "$root/src/workspace_needs/src/workspace_needs/build_cause.py" "$state/build.log" 2>&1 | translated >&2
  fail "$1 "$"(full log: .setup/build.log)"
}
network_failed() {
  grep -qaE 'Temporary failure|Could(n.t| not) resolve|Failed to fetch|Failed getting release file|Couldn.t download|Could not connect|Network is unreachable|Connection (refused|timed out)|NewConnectionError|ConnectTimeout|NameResolution|ProxyError|Max retries|Retry\(total=0,' "$state/$1.log"
}
