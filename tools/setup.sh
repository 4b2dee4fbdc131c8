#!/usr/bin/env bash
# Installs packages (Debian 12, Ubuntu 24.04) and changes nothing else. Needs root or sudo if packages are missing. If
# none are missing, does nothing and needs neither apt nor a network. Each size includes the sizes above it:
#   tools/setup.sh build   to build and run weir
#   tools/setup.sh package to make weir's Debian package, with the Python module in it (tools/package.sh)
#   tools/setup.sh test    to run the tests (tools/test.sh); the default
#   tools/setup.sh check   to run sanitizers, fuzzers and linters (tools/test.sh --ci and --full)
set -euo pipefail

size=${1:-test}
build=(
  g++ cmake ninja-build git ca-certificates
  libtbb-dev libspdlog-dev nlohmann-json3-dev libcli11-dev libtomlplusplus-dev libxxhash-dev
  zlib1g-dev libpng-dev libtinyexr-dev libopenvdb-dev libboost-dev libhdf5-dev libpugixml-dev
  libzfp-dev libfftw3-dev libblosc-dev libzstd-dev libjpeg-dev libsqlite3-dev libcairo2-dev pkg-config
)
package=(dpkg-dev file pybind11-dev python3-dev python3-numpy)
test=(
  libgtest-dev libnanovdb-dev libnanovdb-tools libopenvdb-tools python3-jsonschema xz-utils
  libopenmpi-dev openmpi-bin
  python3-h5py python3-netcdf4 python3-nibabel python3-xarray python3-dask python3-zarr python3-urllib3 python3-fsspec hdf5-filter-plugin hdf5-filter-plugin-blosc-serial
  hdf5-filter-plugin-zfp-serial groff-base zsh fish gfortran
)
check=(libbenchmark-dev clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev shellcheck)
if grep -qx 'ID=debian' /etc/os-release 2>/dev/null; then
  # For the tests of the daemon's page, and to evaluate ZFP's own command. Ubuntu has no such packages (its chromium
  # is a snap), so the tests that need them are skipped there.
  test+=(chromium chromium-driver zfp)
  check+=(python3-yt) # for tools/test.sh --full
fi
# VTK and a virtual display, to test bindings/paraview. Skipped if ParaView is installed: ParaView has its own VTK,
# and installing python3-vtk9 would remove it.
if [[ $(dpkg-query --show --showformat '${db:Status-Abbrev}' python3-paraview 2>/dev/null || true) != ii* ]]; then
  test+=(python3-vtk9 xvfb xauth)
fi

case $size in
  build) packages=("${build[@]}") ;;
  package) packages=("${build[@]}" "${package[@]}") ;;
  test) packages=("${build[@]}" "${package[@]}" "${test[@]}") ;;
  check) packages=("${build[@]}" "${package[@]}" "${test[@]}" "${check[@]}") ;;
  *)
    echo "tools/setup.sh: unknown size '$size': use build, package, test or check" >&2
    exit 2
    ;;
esac

missing=()
for name in "${packages[@]}"; do
  # shellcheck disable=SC2016  # dpkg-query expands it, not the shell
  status=$(dpkg-query --show --showformat '${db:Status-Abbrev}' "$name" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$name")
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
# A failed update prints its log but does not end the script, because the old package lists may still suffice.
apt update || sed 's/^/  /' "$log" >&2
if ! apt install --yes --no-install-recommends "${missing[@]}"; then
  sed 's/^/  /' "$log" >&2
  echo "tools/setup.sh: apt-get could not install: ${missing[*]}" >&2
  exit 1
fi
