#!/usr/bin/env bash
# Installs what is missing, builds and runs the tests of the labels unit, data and device.
# usage: scripts/test.sh [--all]
#   --all   also label slow, clang-format, clang-tidy (preset lint), ASan+UBSan (preset asan), and
#           TSan (preset tsan) on what reads and measures on several threads
set -euo pipefail

all=false
for argument in "$@"; do
  case $argument in
    --all) all=true ;;
    -h | --help)
      sed -n '2,5s/^# //p' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *)
      echo "test.sh: unknown argument '$argument'; expected --all" >&2
      exit 2
      ;;
  esac
done

. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "$root"

# run_tests PRESET LABELS: ctest without a line for each test that passes.
run_tests() {
  echo "ctest ($1): ${2//|/, }"
  ctest --preset "$1" --label-regex "^($2)\$" --parallel "$(nproc)" | failures_and_summary
}

check_format() {
  find include src apps tests bench \( -name '*.h' -o -name '*.cc' \) -print0 |
    xargs -0 clang-format --dry-run --Werror
}

# build_preset PRESET [TARGETS]
build_preset() {
  stage "configure $1" cmake --preset "$1"
  stage "build $1" cmake --build --preset "$1" --target "${@:2}"
}

if $all; then scripts/install_deps.sh --tests --lint; else scripts/install_deps.sh --tests; fi

shared_data=${STEREOMOTION_SHARED_DATA:-$root/../shared/data}
if [[ ! -d $shared_data ]]; then
  echo "SKIPPED: tests on $shared_data (absent; STEREOMOTION_SHARED_DATA names another place)"
fi

if ! $all; then
  build_preset release all
  run_tests release 'unit|data|device'
  exit
fi

build_preset release all slow_tests
run_tests release 'unit|data|device|slow'
stage "check format" check_format
build_preset lint all slow_tests
build_preset asan all
run_tests asan 'unit|data|device'
build_preset tsan all
run_tests tsan 'unit|data'
