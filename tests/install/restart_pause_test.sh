#!/usr/bin/env bash
# Three starts are immediate, the fourth waits a second, and a start of long ago does not count.
set -euo pipefail
pause=${1:?the script}

RUNTIME_DIRECTORY=$(mktemp -d)
export RUNTIME_DIRECTORY
trap 'rm -rf "$RUNTIME_DIRECTORY"' EXIT

fail() {
  echo "error: $*" >&2
  exit 1
}

# Milliseconds that a start of the service waits.
waits_ms() {
  local begin
  begin=$(date +%s%3N)
  "$pause" "$1"
  echo $(($(date +%s%3N) - begin))
}

for start in 1 2 3; do
  (($(waits_ms tracking) < 900)) || fail "start $start waits"
done
(($(waits_ms tracking) >= 1000)) || fail "the fourth start does not wait"
(($(waits_ms detection) < 900)) || fail "another service waits"
printf '%s\n' 1 2 3 4 5 >"$RUNTIME_DIRECTORY/old.starts"
(($(waits_ms old) < 900)) || fail "starts of long ago count"
