#!/usr/bin/env bash
# Installs a build into a folder of its own. Another project finds the libraries there by CMake and by pkg-config, compiles
# and runs; the installed program finds its profiles and scenarios there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=${1:?folder of the build}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
prefix=$folder/installed
expected="20 1 3"  # m: of the filter, the graph and the metric in external/main.cpp

fail() {
  echo "error: $*" >&2
  exit 1
}

expect() {
  local what=$1 wanted=$2
  shift 2
  local got
  got=$("$@") || fail "$what: exit code $?"
  [[ $got == "$wanted" ]] || fail "$what prints '$got' instead of '$wanted'"
}

cmake --install "$build" --prefix "$prefix" >"$folder/install.log" || { cat "$folder/install.log"; fail "cmake --install"; }

cmake -S "$here/external" -B "$folder/by_cmake" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >"$folder/configure.log" ||
  { cat "$folder/configure.log"; fail "find_package"; }
cmake --build "$folder/by_cmake"
expect "the project built by CMake" "$expected" "$folder/by_cmake/external"

flags=$(PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name slammot.pc)") pkg-config --cflags --libs slammot)
# shellcheck disable=SC2086  # several words
"${CXX:-c++}" "$here/external/main.cpp" -o "$folder/by_pkg_config" $flags
expect "the program built with pkg-config" "$expected" "$folder/by_pkg_config"

cd "$folder"
unset SLAMMOT_PROFILES SLAMMOT_SCENARIOS
"$prefix/bin/slammot" run --scenario truck --profile urban --output "$folder/out" >"$folder/run.log" ||
  { cat "$folder/run.log"; fail "slammot run"; }
[[ -s $folder/out/tracks.csv ]] || fail "slammot run writes no tracks"
for program in "$build"/bin/slammot-*; do
  name=$(basename "$program")
  [[ -x $prefix/bin/$name ]] || fail "$name is not installed"
done
! grep -rIl "$build" "$prefix" || fail "these files name the folder of the build"
