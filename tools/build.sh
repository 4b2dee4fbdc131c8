#!/usr/bin/env bash
# Configures and builds: tools/build.sh [PRESET] [TARGET...]
#   These presets build in build/release: command (only weir), package (everything that is installed), release (the
#   default: package, tests and benchmarks). These build in build/PRESET: core (without the optional parts), asan (with
#   the fuzzers), tsan, tidy.
# The command is build/release/weir. Uses ccache if it is installed. Prints the progress and writes the build's whole
# output to build/PRESET/build.log, or build/release/build.log. WEIR_CUDA=ON|OFF in the environment says whether to
# compile the kernels. By default they are compiled if a CUDA device answers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
[[ $# -eq 0 ]] || shift
case $preset in
  command | package | release) folder=build/release ;;
  core | asan | tsan | tidy) folder=build/$preset ;;
  *)
    echo "tools/build.sh: unknown preset '$preset': use command, package, release, core, asan, tsan or tidy" >&2
    exit 2
    ;;
esac

if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
fi

mkdir -p "$folder"
log=$folder/build.log
options=()
[[ $folder != build/release ]] || options+=(-DWEIR_CUDA="${WEIR_CUDA:-AUTO}")
[[ $folder != build/release ]] || options+=(-DWEIR_SLOW_TESTS="${WEIR_SLOW_TESTS:-ON}")
[[ -z ${WEIR_TESTS+x} ]] || options+=(-DWEIR_TESTS="$WEIR_TESTS")
[[ -z ${WEIR_TESTS_LEFT_OUT+x} ]] || options+=(-DWEIR_TESTS_LEFT_OUT="$WEIR_TESTS_LEFT_OUT")
[[ -z ${WEIR_TEST_FOLDERS+x} ]] || options+=(-DWEIR_TEST_FOLDERS="$WEIR_TEST_FOLDERS")
if ! cmake --preset "$preset" "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
# The compiler takes up to 1.5 GiB for a group of sources.
jobs=$(awk -v most="$(nproc)" '/^MemAvailable:/ {jobs = int($2 / 1572864)} END {print (jobs < 1 ? 1 : jobs > most ? most : jobs)}' \
  /proc/meminfo)
build=(cmake --build --preset "$preset" --parallel "$jobs")
[[ $# -eq 0 ]] || build+=(--target "$@")
build+=(-- -k 0) # one run names every file that fails
if [[ -t 1 ]]; then
  # Ninja shows its steps on one line; script gives it the terminal that the log needs.
  if command -v script >/dev/null; then
    exec script --quiet --return --flush --log-out "$log" --command "${build[*]@Q}"
  fi
  exec "${build[@]}"
fi

# Without a terminal, prints a line about every 15 seconds.
show_steps() {
  local line next=$((SECONDS + 15))
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$log"
    if ((SECONDS >= next)) && [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      echo "  built ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} steps, $SECONDS s"
      next=$((SECONDS + 15))
    fi
  done
}
if ! "${build[@]}" 2>&1 | show_steps; then
  grep -v '^\[[0-9]*/[0-9]*\] ' "$log" | tail -n 200 >&2
  echo "tools/build.sh: the $preset build failed; all of it is in $log" >&2
  exit 1
fi
