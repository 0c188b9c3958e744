#!/usr/bin/env bash
# Measures the recording in data/demo: installs what is missing, builds, runs, prints the result.
# usage: scripts/demo.sh
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "$root"

demo=$root/data/demo
run=$root/build/demo
program=$root/build/release/apps/stereomotion

scripts/install_deps.sh
stage "configure release" cmake --preset release
stage "build stereomotion" cmake --build --preset release --target stereomotion_app
stage "measure data/demo" "$program" track --left "$demo/cam0" --right "$demo/cam1" \
  --rig "$demo/rig.yaml" --body "$demo/body.yaml" --output "$run" --force

echo
LC_ALL=C awk -F, -f scripts/pose_table.awk "$demo/truth/poses.csv" "$run/poses.csv"
echo
echo "The files (docs/formats.md says what stands in them):"
for file in "$run"/*; do echo "  $file"; done
echo "Your own recording:"
echo "  $program track --help"
