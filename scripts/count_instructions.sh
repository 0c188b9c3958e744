#!/usr/bin/env bash
# Counts the instructions of detection with callgrind: the figure that no other load disturbs. Needs
# Debian's valgrind, whose machine has AVX2 but no AVX-512.
# usage: scripts/count_instructions.sh [BENCH]     (default build/release/bench/stereomotion_bench)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bench=${1:-build/release/bench/stereomotion_bench}
command -v valgrind >/dev/null || {
  echo "count_instructions.sh: valgrind is not installed (apt-get install valgrind)" >&2
  exit 3
}
out=$(mktemp)
trap 'rm -f "$out"' EXIT
# Only whole searches are counted; the number of frames is that of the calls.
valgrind -q --tool=callgrind --callgrind-out-file="$out" --collect-atstart=no \
  --toggle-collect='stereomotion::BallDetector::Detect(stereomotion::ImageView const&, std::vector<*' \
  "$bench" --benchmark_filter='Detect/hot_ml$' --benchmark_repetitions=1 --benchmark_min_time=0.001 \
  >/dev/null
callgrind_annotate --inclusive=yes --threshold=99.9 "$out" | grep -E 'Detect\(|EstimateBackground|Segmenter::Segment\(|FitBall|PROGRAM TOTALS' |
  cut -c1-150 | head -20
