# Shared by the scripts of this folder: source it, do not run it.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# shellcheck source-path=SCRIPTDIR source=packages.sh
source "$root/deploy/packages.sh"

# Shares compiled objects between checkouts, and with the image through build/objects, which is part of its build context.
# The locale is ignored: the image has none.
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_COMPILERCHECK=content CCACHE_SLOPPINESS=locale
export CCACHE_REMOTE_STORAGE="file:$root/build/objects" CCACHE_RESHARE=1

# Every C++ file of the tree, one a line.
cpp_files() {
  find "$root"/{common,examples,services,tests} -name '*.[ch]pp' | sort
}

# Passes further arguments to cmake.
configure_preset() {
  local preset=$1
  shift
  say "Configuring the preset '$preset' in build/$preset"
  cmake -S "$root" --preset "$preset" --log-level=WARNING "$@"
}

# Further arguments are targets; default: everything.
build_preset() {
  local preset=$1
  shift
  say "Building ${*:-everything} in build/$preset"
  cmake --build "$root/build/$preset" ${1:+--target "$@"}
}

# A small drive through a simulated town, with ground truth. Simulated once for each version of the program.
drive_folder=out/drive
drive_log=$drive_folder/block.log
# make_drive VERSION COMMAND...: COMMAND is slammot; $drive_seen_as is the folder's path for it, if it differs.
make_drive() {
  local version=$1
  shift
  if [[ $(cat "$drive_folder/made-by" 2>/dev/null) == "$version" ]]; then
    say "The drive exists: $drive_log"
    return
  fi
  say "Simulating a small drive into $drive_folder"
  mkdir -p "$drive_folder"
  "$@" simulate block --output "${drive_seen_as:-$drive_folder}"
  echo "$version" >"$drive_folder/made-by"
}

engine_runs() { command -v docker >/dev/null && timeout 20 docker info >/dev/null 2>&1; }

# Builds the image if a Docker engine runs; otherwise the container test is skipped.
build_image_where_possible() {
  if engine_runs; then
    "$root/deploy/image"
  else
    say "No Docker engine runs: no image is built and the container test is skipped"
  fi
}
