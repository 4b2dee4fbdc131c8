#!/usr/bin/env bash
# Configures and builds build/PRESET/: tools/build.sh [release|asan|tsan|fuzz|tidy] [TARGET...]
# The command is then build/PRESET/weir. Uses ccache where it is installed. Silent unless it fails or stdout
# is a terminal.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
[[ $# -eq 0 ]] || shift
case $preset in
  release | asan | tsan | fuzz | tidy) ;;
  *)
    echo "tools/build.sh: unknown preset '$preset': use release, asan, tsan, fuzz or tidy" >&2
    exit 2
    ;;
esac

if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
fi

mkdir -p "build/$preset"
log=build/$preset/build.log
if ! cmake --preset "$preset" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
build=(cmake --build --preset "$preset" --parallel "$(nproc)")
[[ $# -eq 0 ]] || build+=(--target "$@")
# -k 0: one run names every file that fails.
if [[ -t 1 ]]; then
  "${build[@]}" -- -k 0
elif ! "${build[@]}" -- -k 0 >"$log" 2>&1; then
  grep -v '^\[[0-9]*/[0-9]*\] ' "$log" | tail -n 200 >&2
  echo "tools/build.sh: the $preset build failed; all of it is in $log" >&2
  exit 1
fi
