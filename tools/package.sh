#!/usr/bin/env bash
# Makes the Debian package build/package/weir_VERSION_ARCH.deb from a clean copy of the checked-out commit. The
# package is for the distribution release that this script runs on. Installs the packages that the build needs.
#   WEIR_MAINTAINER='NAME <ADDRESS>'   the maintainer that the package names
set -euo pipefail
umask 022 # apt reads the package as another user
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh package
copy=$PWD/build/package/source
rm -rf "$copy" build/package/*.deb
mkdir -p build/package
git clone --quiet --shared . "$copy"

cd "$copy"
tools/build.sh package
cd build/release
cpack ${WEIR_MAINTAINER:+-D CPACK_PACKAGE_CONTACT="$WEIR_MAINTAINER"} >/dev/null
cd ../../..
mv source/build/release/*.deb .
rm -rf source
ls "$PWD"/*.deb
