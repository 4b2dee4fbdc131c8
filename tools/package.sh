#!/usr/bin/env bash
# Makes the Debian package of the commit that is checked out, from a clean copy of it: build/package/weir_VERSION_ARCH.deb,
# for the release of the distribution that this runs on. Installs what it needs for that.
#   WEIR_MAINTAINER='NAME <ADDRESS>'   to be named in it
set -euo pipefail
umask 022 # apt reads the package as a user of its own
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
