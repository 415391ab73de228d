#!/usr/bin/env bash
# deploy/format refuses a badly formatted file, formats it, and then accepts it.
set -euo pipefail
cd "${1:?root of the tree}"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=$folder/bad.cpp
printf 'int  twice( int a ){\nreturn 2*a ;}\n' >"$bad"

code=0
deploy/format --check "$bad" || code=$?
[[ $code != 77 ]] || exit 77
[[ $code != 0 ]] || { echo "error: --check accepts a badly formatted file" >&2; exit 1; }
grep -q 'int  twice' "$bad" || { echo "error: --check changes a file" >&2; exit 1; }

deploy/format "$bad"
deploy/format --check "$bad"
grep -q '^int twice(int a) { return 2 \* a; }$' "$bad" || { cat "$bad"; echo "error: not formatted" >&2; exit 1; }
