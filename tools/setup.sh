#!/usr/bin/env bash
# Installs the packages weir is built, run and checked with (Debian 12, Ubuntu 24.04); touches nothing else.
# A no-op without apt or network where all are there already. Needs root, or sudo.
set -euo pipefail

packages=(
  # to build
  g++ cmake ninja-build git ca-certificates
  libtbb-dev libspdlog-dev nlohmann-json3-dev libcli11-dev libtomlplusplus-dev libxxhash-dev
  zlib1g-dev libpng-dev libtinyexr-dev libnanovdb-dev libopenvdb-dev libboost-dev libhdf5-dev libpugixml-dev
  libzfp-dev libsqlite3-dev pybind11-dev python3-dev python3-numpy
  libopenmpi-dev openmpi-bin
  # to test
  libgtest-dev libbenchmark-dev libnanovdb-tools libopenvdb-tools python3-jsonschema xz-utils
  python3-h5py python3-netcdf4 python3-nibabel hdf5-filter-plugin hdf5-filter-plugin-blosc-serial
  hdf5-filter-plugin-zfp-serial groff-base zsh fish dpkg-dev file gfortran pkg-config
  # to check
  clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev shellcheck
)
# To test the daemon's page. Ubuntu has no such packages (its chromium is a snap); the tests are skipped there.
if grep -qx 'ID=debian' /etc/os-release 2>/dev/null; then packages+=(chromium chromium-driver); fi
# ZFP's own command, to evaluate it; what needs it is skipped where it is missing. Looked for in Debian alone.
if grep -qx 'ID=debian' /etc/os-release 2>/dev/null; then packages+=(zfp); fi

# VTK and a display for its pictures, to test bindings/paraview. ParaView has a VTK of its own, which this one would remove.
if [[ $(dpkg-query --show --showformat '${db:Status-Abbrev}' python3-paraview 2>/dev/null || true) != ii* ]]; then
  packages+=(python3-vtk9 xvfb xauth)
fi

missing=()
for package in "${packages[@]}"; do
  # shellcheck disable=SC2016  # dpkg-query expands it, not the shell
  status=$(dpkg-query --show --showformat '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$package")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "tools/setup.sh: missing packages: ${missing[*]}; run it as root, or install sudo" >&2
    exit 1
  fi
  as_root=(sudo)
  [[ -t 0 ]] || as_root+=(-n)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" </dev/null >"$log" 2>&1; }

echo "installing ${#missing[@]} packages: ${missing[*]}"
# Old lists may still do, so a failed update only shows up where the install fails as well.
apt update || sed 's/^/  /' "$log" >&2
if ! apt install --yes --no-install-recommends "${missing[@]}"; then
  sed 's/^/  /' "$log" >&2
  echo "tools/setup.sh: apt-get could not install: ${missing[*]}" >&2
  exit 1
fi
