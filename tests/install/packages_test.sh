#!/usr/bin/env bash
# Packs a build as Debian packages and judges them without installing: contents, configuration files, units.
set -euo pipefail
build=${1:?folder of the build}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "error: $*" >&2
  exit 1
}

for tool in cpack dpkg-deb dpkg-shlibdeps systemd-analyze; do
  command -v "$tool" >/dev/null || { echo "skipped: there is no $tool"; exit 77; }
done

(cd "$build" && cpack -B "$folder/debs" -D CPACK_DEBIAN_COMPRESSION_TYPE=none >"$folder/cpack.log" 2>&1) || { tail -20 "$folder/cpack.log"; fail "cpack"; }
root=$folder/root
for role in common sensors estimation closing view tools; do
  deb=("$folder"/debs/slammot-"$role"_*.deb)
  dpkg-deb -x "${deb[0]}" "$root"
done
dpkg-deb -x "$(ls "$folder"/debs/slammot_*.deb)" "$root"

for program in "$build"/bin/slammot-*; do
  name=$(basename "$program")
  [[ -x $root/usr/bin/$name ]] || [[ $name == *_test ]] || fail "no package has $name"
done
! dpkg-deb -c "$folder"/debs/slammot_*.deb | grep -q /usr/bin || fail "the package that needs all others holds programs itself"
dpkg-deb -f "$folder"/debs/slammot-estimation_*.deb Depends | grep -q libddsc0debian || fail "a package does not name its libraries"
dpkg-deb -I "$folder"/debs/slammot-common_*.deb conffiles | grep -q /etc/slammot/slammot.env || fail "slammot.env is no configuration file"

units=()
for unit in "$root"/usr/lib/systemd/system/slammot.target.wants/*; do
  units+=("$(basename "$unit")")
  grep -q "^SLAMMOT_DOMAIN=" "$root/etc/slammot/slammot.env" || fail "slammot.env names no domain"
  program=$(basename "$unit" .service)
  [[ -x $root/usr/bin/slammot-${program#slammot@} ]] || fail "$(basename "$unit") has no program"
done
[[ ${#units[@]} == 7 ]] || fail "slammot.target starts ${units[*]}"

# The root has none of the system's own units.
words=$(systemd-analyze verify --man=no --root="$root" "${units[@]}" slammot@ingest.service 2>&1 | grep -i slammot | grep -v "Failed to create" || true)
[[ -z $words ]] || fail "units: $words"
systemd-analyze security --offline=true --threshold=20 --root="$root" slammot@localization.service >"$folder/security.txt" ||
  fail "the unit is more exposed than 2.0: $(tail -1 "$folder/security.txt")"
tail -1 "$folder/security.txt"
