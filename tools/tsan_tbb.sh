#!/usr/bin/env bash
# Builds oneTBB with ThreadSanitizer into build/cache/tsan_tbb/, once, from the sources of the distribution's package.
# With an ordinary oneTBB the sanitizer does not see how TBB orders accesses, and reports races that do not exist.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cache=$PWD/build/cache/tsan_tbb
[[ ! -e $cache/lib/libtbb.so.12 ]] || exit 0
mkdir -p "$cache"/{lists/partial,parts,source}

# The machine's apt sources, rewritten to list source packages.
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
  [[ ! -e $list ]] || sed -n 's/^deb /deb-src /p' "$list" >"$cache/parts/$(basename "$list" .list)_source.list"
done
for list in /etc/apt/sources.list.d/*.sources; do
  [[ ! -e $list ]] || sed 's/^Types: .*/Types: deb-src/' "$list" >"$cache/parts/$(basename "$list" .sources)_source.sources"
done
: >"$cache/none.list"
apt() {
  apt-get -qq -o Dir::Etc::SourceList="$cache/none.list" -o Dir::Etc::SourceParts="$cache/parts" \
    -o Dir::State::Lists="$cache/lists" -o APT::Sandbox::User=root "$@"
}
apt update
cd "$cache/source"
apt source --download-only onetbb
rm -rf tree
mkdir tree
tar -xf onetbb_*.orig.tar.* -C tree --strip-components 1

cmake -S tree -B build -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS="-fsanitize=thread -O1 -fno-omit-frame-pointer" \
  -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF -DCMAKE_INSTALL_PREFIX="$cache" -DCMAKE_INSTALL_LIBDIR=lib
cmake --build build --parallel "$(nproc)"
cmake --install build
