#!/usr/bin/env bash
# Installs the Debian packages that stereomotion needs, those only that are missing; asks nothing.
# usage: scripts/install_deps.sh [--tests] [--lint] [--plots] [--fuzz]
#   --tests   also what the tests of live cameras and recording files need
#   --lint    also what preset lint and pre-commit need
#   --plots   also what draws the plots of the documentation (scripts/accuracy.sh)
#   --fuzz    also what scripts/fuzz.sh needs
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

packages=(
  ca-certificates g++ cmake ninja-build ccache python3 dpkg-dev file
  libeigen3-dev libopencv-dev libyaml-cpp-dev libtomlplusplus-dev nlohmann-json3-dev
  libfmt-dev libspdlog-dev libcli11-dev libssl-dev zlib1g-dev libapriltag-dev libceres-dev
  pkg-config libaravis-dev libusb-1.0-0-dev libhdf5-dev libzmq3-dev # aravis-0.8.pc asks for libusb
  libgtest-dev libbenchmark-dev
)
for argument in "$@"; do
  case $argument in
    --lint) packages+=(clang-tidy clang-format) ;;
    # Tests of live cameras: a network and a kernel of their own; other readers of our files.
    --tests) packages+=(iproute2 util-linux qemu-system-x86 busybox-static cpio make libelf1
      python3-h5py) ;;
    --plots) packages+=(python3-matplotlib) ;;
    --fuzz) packages+=(clang libclang-rt-dev) ;;
    *)
      echo "install_deps.sh: unknown argument '$argument'; expected --tests, --lint, --plots or --fuzz" >&2
      exit 2
      ;;
  esac
done

is_installed() { [[ $(dpkg-query -W -f='${Status}' "$1" 2>/dev/null) == *' installed' ]]; }

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then exit 0; fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "install_deps.sh: run as root or install sudo; missing: ${missing[*]}" >&2
    exit 3
  fi
  as_root=(sudo)
  sudo true # in the foreground, should it want a password
fi
# Behind `env` because sudo drops the caller's environment. The lock may be held by a daily upgrade.
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y
  -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3)

install() { "${apt[@]}" install --no-install-recommends "${missing[@]}"; }
# A fresh machine has no package lists, an old one stale ones: only then are they fetched.
install_or_update() { install || { "${apt[@]}" update && install; }; }

stage "install ${#missing[@]} packages" install_or_update || {
  echo "install_deps.sh: apt-get could not install: ${missing[*]}" >&2
  exit 3
}
