# Installs the packages of deploy/packages.txt: source it, do not run it. Separate from common.sh, so that the image's
# layer of packages is rebuilt only when the packages change.
# shellcheck shell=bash

packages_list=$(dirname "${BASH_SOURCE[0]}")/packages.txt

say() { printf '\n==> %s\n' "$*"; }

die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# Prints the packages of the named sections of packages.txt, one per line.
packages_of() {
  local section
  for section in "$@"; do
    grep -q "^\[$section\]" "$packages_list" || die "deploy/packages.txt has no section [$section]"
    sed -n "/^\[$section\]/,/^\[/{/^\[/d;s/[[:space:]]*#.*//;/^$/d;p}" "$packages_list"
  done
}

# Prints those of the given packages that are not installed.
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
    die "packages are missing: run this as root, or install sudo"
  fi
}

# Installs the missing packages of the named sections. Needs no network if none is missing.
install_packages() {
  local packages missing
  mapfile -t packages < <(packages_of "$@")
  mapfile -t missing < <(missing_of "${packages[@]}")
  if [[ ${#missing[@]} == 0 ]]; then
    say "All ${#packages[@]} Debian packages are installed"
    return
  fi
  command -v apt-get >/dev/null || die "this is not Debian; install the equivalents of: ${missing[*]}"
  say "Installing ${#missing[@]} of ${#packages[@]} Debian packages: ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}
