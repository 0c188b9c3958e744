#!/usr/bin/env bash
# Fuzzes the detector with libFuzzer under AddressSanitizer and UndefinedBehaviorSanitizer.
# usage: scripts/fuzz.sh [SECONDS]     (default 300)
# Builds in build/fuzz with clang (scripts/install_deps.sh --fuzz); without clang: exit code 77, which
# ctest reports as skipped. Inputs that led somewhere new are kept in build/fuzz/corpus; one that fails
# is written to build/fuzz/crash-…, and `build/fuzz/tests/detection/detect_fuzzer FILE` repeats it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:-300}
# The longest a single input may take: an image of at most 65 kpx, under sanitizers, three searches.
readonly timeout_s=10

if ! command -v clang++ >/dev/null; then
  echo "fuzz.sh: SKIPPED, clang++ is not installed (scripts/install_deps.sh --fuzz installs it)"
  exit 77
fi

build=${FUZZ_BUILD:-build/fuzz}
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DSTEREOMOTION_FUZZ=ON -DSTEREOMOTION_BUILD_BENCH=OFF >"$build.log" 2>&1 || {
  cat "$build.log"
  exit 1
}
cmake --build "$build" --target detect_fuzzer
mkdir -p "$build/corpus"
cd "$build"
exec tests/detection/detect_fuzzer -max_total_time="$seconds" -max_len=4096 -timeout="$timeout_s" \
  -print_final_stats=1 -verbosity=1 corpus
