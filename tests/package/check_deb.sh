#!/usr/bin/env bash
# Packs the build tree into Debian packages, unpacks them beside the system and runs the program.
# usage: check_deb.sh BUILD_DIR WORK_DIR VERSION
set -euo pipefail
build=$1 work=$2 version=$3

fail() {
  echo "check_deb: $*" >&2
  exit 1
}

rm -rf "$work"
mkdir -p "$work"
(cd "$build" && cpack -G DEB -B "$work/out") >"$work/cpack.log" 2>&1 ||
  fail "cpack failed: $(tail -n 20 "$work/cpack.log")"

program=$(find "$work/out" -maxdepth 1 -name 'stereomotion_*.deb')
library=$(find "$work/out" -maxdepth 1 -name 'libstereomotion-dev_*.deb')
[[ -f $program && -f $library ]] || fail "expected two packages, found: $(ls "$work/out")"

field() { dpkg-deb --field "$program" "$1"; }
[[ $(field Package) == stereomotion ]] || fail "package is called $(field Package)"
[[ $(field Version) == "$version"* ]] || fail "version is $(field Version), expected $version"
depends=$(field Depends)
for needed in libc6 libopencv-core libyaml-cpp; do
  [[ $depends == *"$needed"* ]] || fail "does not depend on $needed: $depends"
done

dpkg-deb --extract "$program" "$work/root"
dpkg-deb --extract "$library" "$work/root"
said=$("$work/root/usr/bin/stereomotion" --version)
[[ $said == *"$version"* ]] || fail "stereomotion --version says '$said', expected $version"
[[ -f $work/root/usr/include/stereomotion/pipeline/measure.h ]] || fail "headers are missing"

dpkg-deb --info "$program"
echo "$said"
