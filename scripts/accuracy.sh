#!/usr/bin/env bash
# Measures the accuracy of the detectors anew: builds and runs the studies, draws docs/accuracy/*.png
# and writes the tables of docs/accuracy.md.
# usage: scripts/accuracy.sh [--quick]
#   --quick   few balls, into build/accuracy-quick: only to see that all works (docs/ stays as it is)
set -euo pipefail

quick=
case ${1:-} in
  '') ;;
  --quick) quick=--quick ;;
  -h | --help)
    sed -n '2,5s/^# //p' "${BASH_SOURCE[0]}"
    exit 0
    ;;
  *)
    echo "accuracy.sh: unknown argument '$1'; expected --quick" >&2
    exit 2
    ;;
esac

. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "$root"

if ! python3 -c 'import matplotlib' 2>/dev/null; then
  echo "accuracy.sh: needs matplotlib to draw: scripts/install_deps.sh --plots" >&2
  echo "             (Debian's package python3-matplotlib)" >&2
  exit 3
fi

results=build/accuracy${quick:+-quick}-csv  # from $root
plots=$root/docs/accuracy
page=$root/docs/accuracy.md
mkdir -p "$results"
if [[ -n $quick ]]; then
  plots=$results
  cp "$page" "$results/accuracy.md"
  page=$results/accuracy.md
fi

# The studies, each with what it is told: where to write, and that the run is to be short.
declare -A studies=(
  [stereomotion_accuracy_study]="--output $results $quick"
  [stereomotion_exposure_study]="--output $results $quick"
  [stereomotion_edge_study]="--output $results"
  [stereomotion_center_study]="--output $results $quick"
  [stereomotion_scaling_bench]="--output $results/scaling.csv"
)
order=(stereomotion_accuracy_study stereomotion_exposure_study stereomotion_edge_study
  stereomotion_center_study stereomotion_scaling_bench)

scripts/install_deps.sh
stage "configure release" cmake --preset release
targets=$(ninja -C build/release -t targets all)
for study in "${order[@]}"; do
  if ! grep -q "^$study:" <<<"$targets"; then
    echo "SKIPPED: $study (not a part of this version)"
    continue
  fi
  stage "build ${study#stereomotion_}" cmake --build --preset release --target "$study"
  read -ra options <<<"${studies[$study]}"
  stage "run ${study#stereomotion_}" "build/release/bench/$study" "${options[@]}"
done
stage "draw" python3 scripts/plot_accuracy.py "$results" "$plots"
python3 scripts/accuracy_tables.py "$results" "$page"
echo "tables: ${page#"$root"/}, plots: ${plots#"$root"/}, CSV files: ${results#"$root"/}"
