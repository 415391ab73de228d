# Shared by the scripts of this folder: source it, do not run it.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n==> %s\n' "$*"; }

die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# Prints the packages of the named sections of packages.txt, one a line.
packages_of() {
  local section
  for section in "$@"; do
    grep -q "^\[$section\]" "$root/deploy/packages.txt" || die "deploy/packages.txt has no section [$section]"
    sed -n "/^\[$section\]/,/^\[/{/^\[/d;s/[[:space:]]*#.*//;/^$/d;p}" "$root/deploy/packages.txt"
  done
}

# Those of the given packages that dpkg does not hold as installed.
missing_of() {
  local package
  for package in "$@"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
  done
}

as_root() {
  if [[ $(id -u) == 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "packages are missing and have to be installed: run this as root, or install sudo"
  fi
}

# Installs what is missing of the named sections, and nothing when nothing is: no network is needed then.
install_packages() {
  local packages missing
  mapfile -t packages < <(packages_of "$@")
  mapfile -t missing < <(missing_of "${packages[@]}")
  if [[ ${#missing[@]} == 0 ]]; then
    say "All ${#packages[@]} Debian packages are installed"
    return
  fi
  command -v apt-get >/dev/null || die "this is not Debian; install what corresponds to: ${missing[*]}"
  say "Installing ${#missing[@]} of ${#packages[@]} Debian packages: ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# Configures and builds the preset; further arguments are ninja's targets (none: everything).
build_preset() {
  local preset=$1
  shift
  say "Building the preset '$preset' in build/$preset"
  # Objects compiled in another checkout serve this one too.
  export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
  cmake -S "$root" --preset "$preset" --log-level=WARNING
  cmake --build "$root/build/$preset" ${1:+--target "$@"}
}

# A small drive through a simulated town, with its truth: made once by the given slammot, used by demo and compose.
drive_folder=out/drive
drive_log=$drive_folder/drive.log.gz
make_drive() {
  if [[ -s $drive_log ]]; then
    say "The drive is there: $drive_log"
    return
  fi
  say "Simulating a small drive into $drive_folder"
  "$1" simulate --output "$drive_folder"
}

engine_runs() { command -v docker >/dev/null && timeout 20 docker info >/dev/null 2>&1; }

# Builds the image where a Docker engine runs; the container test skips itself where none does.
build_image_where_possible() {
  if engine_runs; then
    "$root/deploy/image"
  else
    say "No Docker engine runs here: no image is built and the container test will be skipped"
  fi
}
