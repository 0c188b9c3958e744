# Shared by the scripts here: `stage`, which runs one long step quietly and shows that it lives.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
log_dir=$root/build/logs
mkdir -p "$log_dir"

stage_pid=
# A stage is a process group of its own, so that Ctrl-C ends the compilers too.
trap '[[ -z $stage_pid ]] || kill -- "-$stage_pid" 2>/dev/null; exit 130' INT TERM

# stage NAME COMMAND…: prints a line with the time that it took; the output goes to a log file and
# comes to light only on failure. Meanwhile the last line of the log is the progress: in place on a
# terminal, a line every 30 s elsewhere.
stage() {
  local name=$1 log status=0 began=$SECONDS
  shift
  log=$log_dir/${name//[^a-z0-9]/_}.log
  set -m
  "$@" >"$log" 2>&1 </dev/null &
  stage_pid=$!
  set +m
  show_progress "$name" "$log" "$began"
  wait "$stage_pid" || status=$?
  stage_pid=
  if [[ $status -ne 0 ]]; then
    printf '%-24s FAILED after %d s; the end of %s:\n' "$name" $((SECONDS - began)) "$log"
    tail -n 60 "$log"
    return "$status"
  fi
  printf '%-24s %4d s\n' "$name" $((SECONDS - began))
}

# The last line of a log, without what is the same on every line of a build.
last_line() {
  local line
  line=$(tail -n 1 "$1")
  line=${line/Building CXX object /}
  printf '%s' "${line/CMakeFiles\/*.dir\//}"
}

show_progress() {
  local name=$1 log=$2 began=$3 last=$SECONDS
  while kill -0 "$stage_pid" 2>/dev/null; do
    sleep 0.2
    if [[ -t 1 ]]; then
      printf '\r\033[K%-24s %4d s  %.46s' "$name" $((SECONDS - began)) "$(last_line "$log")"
    elif ((SECONDS - last >= 30)); then
      last=$SECONDS
      printf '%-24s %4d s … %.80s\n' "$name" $((SECONDS - began)) "$(last_line "$log")"
    fi
  done
  if [[ -t 1 ]]; then printf '\r\033[K'; fi
}

# failures_and_summary: keeps of ctest's output what went wrong and the closing lines, counts
# the rest.
failures_and_summary() {
  local line in_place=
  local passed='^ *([0-9]+)/([0-9]+) Test +#[0-9]+: .*( Passed|\*\*\*Skipped) +[0-9.]+ sec *$'
  while IFS= read -r line; do
    if [[ $line =~ ^\ +Start\ +[0-9]+: ]]; then
      continue
    elif [[ $line =~ $passed ]]; then
      if [[ -t 1 ]]; then
        printf '\r\033[K  %d of %d' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
        in_place=1
      elif ((BASH_REMATCH[1] % 100 == 0)); then
        printf '  %d of %d\n' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
      fi
      continue
    fi
    if [[ -n $in_place ]]; then printf '\r\033[K'; fi
    in_place=
    printf '%s\n' "$line"
  done
}
