#!/usr/bin/env bash
# Every bash script of the tree passes shellcheck. Exit code 77: shellcheck is not installed.
set -euo pipefail
cd "${1:?root of the tree}"

if ! command -v shellcheck >/dev/null; then
  echo "skipped: shellcheck is not installed"
  exit 77
fi
scripts=$(find deploy .ci tests -type f -exec grep -lIE '^#!.*\bbash|shellcheck shell=bash' {} +)
xargs shellcheck -x -P deploy <<<"$scripts"
echo "$(wc -l <<<"$scripts") scripts are clean"
