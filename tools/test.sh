#!/usr/bin/env bash
# The checks, in three sizes:
#   tools/test.sh          the tests of the release build, except the slow ones (tests/slow_tests.txt).
#   tools/test.sh --ci     what CI runs. Adds most of the slow tests; compiles kernels and benchmarks; checks the
#                          format of C++, the shell scripts and the structure of the sources; repeats the tests of the
#                          formats and the readers (except heavy ones) with AddressSanitizer and
#                          UndefinedBehaviorSanitizer, and tests that run threads with ThreadSanitizer; runs each fuzzer
#                          for a short time; builds without HDF5, OpenVDB and all other optional parts, and tests what
#                          the command of that build does differently. If the machine is so slow that CI would not end
#                          in time, the last of these are skipped, with a message.
#   tools/test.sh --full   adds all other tests, all tests with the sanitizers, the property tests over a thousand
#                          volumes, Zarr against npm's zarrita, AMReX against yt, and clang-tidy.
# Prints each step and how long it took last time. Logs are in build/checks/. The last line is `N passed, N failed,
# N skipped`; failed and skipped checks are named above it. Exits with 1 if anything failed.
#   WEIR_FUZZ_SECONDS   seconds for each fuzzer, default 15
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

size='test'
case ${1-} in
  '') ;;
  --ci) size=ci ;;
  --full) size=full ;;
  *)
    echo "tools/test.sh: unknown option '$1': there are --ci and --full" >&2
    exit 2
    ;;
esac

export PATH=/usr/lib/llvm-14/bin:$PATH
logs=build/checks
times=build/check_seconds # a line "SECONDS NAME" for each check of earlier runs
rm -rf "$logs"
mkdir -p "$logs"
touch "$times"
passed=0
failed=()
skipped=()

# begin NAME: prints the step that begins and how long it took last time. end: prints and records how long it took.
begin() {
  step=$1
  step_start=$SECONDS
  local last
  last=$(sed -n "s/^\([0-9]*\) $step\$/\1/p" "$times")
  echo "== $step${last:+ (last time $last s)}"
}
end() {
  local took=$((SECONDS - step_start))
  echo "   $step: $took s"
  sed -i "/^[0-9]* $step\$/d" "$times"
  echo "$took $step" >>"$times"
}

# check NAME COMMAND...: runs a check, logs its output and shows the end of it on failure; returns whether it passed.
check() {
  local name=$1 log=$logs/${1//[\/ ]/_}.log
  shift
  if "$@" >"$log" 2>&1; then
    passed=$((passed + 1))
  else
    failed+=("$name")
    echo "--- $name failed; the end of $log:"
    tail -n 60 "$log"
    return 1
  fi
}

skip() { skipped+=("$1: $2"); }

has() { command -v "$1" >/dev/null; }

# build PRESET [TARGET...]: builds, shows the progress and counts as one check.
build() {
  begin "build of $1"
  local built=true
  tools/build.sh "$@" || built=false
  end
  if $built; then
    passed=$((passed + 1))
  else
    failed+=("build of $1")
    return 1
  fi
}

# run_tests PRESET [COMMAND...]: runs the tests of that build and counts each. COMMAND, if given, starts ctest.
run_tests() {
  local preset=$1 results=$PWD/build/$1/test_results log=$logs/$1.log
  shift
  begin "tests of $preset"
  rm -rf "$results"
  # Two more tests than processors run at a time, because many tests wait for a service or a disk.
  "$@" ctest --preset "$preset" --parallel "$(($(nproc) + 2))" --output-junit "$results/ctest.xml" 2>&1 | show_tests "$results" "$log" || true
  end
  local kind name
  while IFS=$'\t' read -r kind name; do
    case $kind in
      passed) passed=$((passed + name)) ;;
      failed) failed+=("$preset $name") ;;
      skipped) skip "$preset $name" "see $log" ;;
    esac
  done < <(tools/test_results.py "$results" "$logs/$preset.failures" || printf 'failed\ttests cannot be counted\n')
  if [[ -s $logs/$preset.failures ]]; then
    echo "--- tests of $preset that failed; all output is in $log:"
    tail -n 200 "$logs/$preset.failures"
  fi
}

# show_tests RESULTS LOG: writes ctest's output to LOG and prints the progress about every 20 seconds.
show_tests() {
  local line next=$((SECONDS + 20))
  : >"$2"
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$2"
    if ((SECONDS >= next)) && [[ $line =~ ^\ *([0-9]+)/([0-9]+)\ Test ]]; then
      echo "   done ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} test processes ($(cat "$1"/*-*.xml 2>/dev/null | grep -c '<testcase') grouped tests)," \
        "$((SECONDS - step_start)) s"
      next=$((SECONDS + 20))
    fi
  done
}

# too_late MINUTES NAME: returns whether CI has run for more than MINUTES, so that check NAME would not end in time.
# Records NAME as skipped then.
too_late() {
  [[ $size == ci ]] && ((SECONDS > 60 * $1)) || return 1
  skip "$2" "after $((SECONDS / 60)) minutes CI would not end in time; run tools/test.sh --full"
}

run_core() {
  if too_late 50 "build and tests of core"; then return 0; fi
  [[ $size != full ]] || export WEIR_TESTS='*'
  if build core; then run_tests core; fi
  unset WEIR_TESTS
}

run_tsan() {
  if too_late 52 "tests of tsan"; then return 0; fi
  if ! tools/tsan_tbb.sh >"$logs/tsan_tbb.log" 2>&1; then
    skip "tests of tsan" "oneTBB cannot be built for ThreadSanitizer; see $logs/tsan_tbb.log"
    return 0
  fi
  [[ $size != full ]] || export WEIR_TESTS_LEFT_OUT=''
  if build tsan; then
    # Some kernels use more address randomisation than the sanitizer's shadow memory allows.
    if setarch "$(uname -m)" -R true 2>/dev/null; then
      run_tests tsan setarch "$(uname -m)" -R
    else
      run_tests tsan
    fi
  fi
  unset WEIR_TESTS_LEFT_OUT
}

fuzz() {
  local name=${1##*/}
  local corpus=build/asan/corpus/$name seeds=tests/fuzz/corpus/$name
  mkdir -p "$corpus"
  [[ -d $seeds ]] || seeds=
  # New inputs are kept in the first folder; the seeds only start the search. ASan only guesses where thread-local
  # storage of a loaded library lies, and LeakSanitizer crashes if the guess is wrong. So the guess is turned off, as
  # in CMakePresets.json.
  ASAN_OPTIONS=intercept_tls_get_addr=0 "$1" -max_total_time="${WEIR_FUZZ_SECONDS:-15}" -timeout=10 -rss_limit_mb=2048 \
    -artifact_prefix="$logs/" "$corpus" ${seeds:+"$seeds"} >"$logs/fuzz_$name.log" 2>&1
}

run_fuzzers() {
  begin fuzzers
  local fuzzer running=() names=()
  for fuzzer in build/asan/fuzz/*; do
    fuzz "$fuzzer" &
    running+=($!)
    names+=("${fuzzer##*/}")
    while (($(jobs -rp | wc -l) >= $(nproc))); do sleep 0.2; done
  done
  local i
  for i in "${!running[@]}"; do
    if wait "${running[$i]}"; then
      passed=$((passed + 1))
    else
      failed+=("fuzz ${names[$i]}")
      tail -n 30 "$logs/fuzz_${names[$i]}.log"
    fi
  done
  end
}

run_asan() {
  if too_late 45 "tests of asan and fuzzers"; then return 0; fi
  if ! has clang++ || ! compgen -G "$(clang++ -print-resource-dir)/lib/*/libclang_rt.fuzzer*" >/dev/null; then
    skip "tests of asan and fuzzers" "clang or its sanitizers are not installed"
    return 0
  fi
  # What measures the process would measure the sanitizer.
  [[ $size != full ]] || export WEIR_TESTS_LEFT_OUT='*Memory*:*Ceiling*' WEIR_TEST_FOLDERS='format;ingest;compressor;daemon;gpu;tools'
  if build asan; then
    run_fuzzers
    run_tests asan
  fi
  unset WEIR_TESTS_LEFT_OUT WEIR_TEST_FOLDERS
}

run_property_tests() {
  begin "property tests"
  local program test tests=0
  for program in compressor tools; do
    while read -r test; do
      tests=$((tests + 1))
      WEIR_PROPERTY_VOLUMES=1000 check "1000 times $test" "build/release/weir_tests_$program" --gtest_filter="$test" || true
    done < <("build/release/weir_tests_$program" --gtest_filter='*Property.*' --gtest_list_tests |
      awk '/^[^ ]/ {suite = $1} /^ / {print suite $1}')
  done
  ((tests >= 3)) || failed+=("property tests: $tests were found")
  end
}

# Zarr arrays against what npm's zarrita reads of them.
run_zarrita() {
  if ! has npm || ! npm install --prefix build/npm --no-audit --no-fund zarrita@0.7 >"$logs/npm.log" 2>&1; then
    skip "Zarr against zarrita" "npm is not there, or cannot install it; see $logs/npm.log"
    return 0
  fi
  WEIR_NODE_MODULES=$PWD/build/npm/node_modules check "Zarr against zarrita" build/release/weir_tests_ingest \
    --gtest_filter='ZarrOracle.*' || true
}

# Composites of AMReX plotfiles against the covering grids of yt.
run_yt() {
  if ! /usr/bin/python3 -c 'import yt' 2>/dev/null; then
    skip "AMReX against yt" "python3-yt is not installed"
    return 0
  fi
  WEIR_YT=1 check "AMReX against yt" build/release/weir_tests_ingest --gtest_filter='YtOracle.*' || true
}

check_format() {
  if ! has clang-format; then
    skip clang-format "not installed"
    return 0
  fi
  git ls-files -z -- '*.h' '*.cpp' '*.cu' '*.cuh' >"$logs/sources"
  check clang-format xargs -0 --arg-file "$logs/sources" clang-format --dry-run -Werror || true
}

check_shell() {
  if ! has shellcheck; then
    skip shellcheck "not installed"
    return 0
  fi
  check shellcheck shellcheck tools/*.sh bench/*.sh .ci/run packaging/postinst packaging/postrm packaging/prerm || true
}

check_tidy() {
  if ! has clang-tidy; then
    skip clang-tidy "not installed"
    return 0
  fi
  build tidy || true # only files that changed, or whose headers did, are looked at again
}

begin packages
setup='test'
[[ $size == test ]] || setup=check
if tools/setup.sh "$setup"; then passed=$((passed + 1)); else failed+=(packages); fi
end
exec </dev/null

if [[ $size != test ]]; then
  check_format
  check_shell
  check structure tools/structure.py || true
  if has nvcc || [[ -x /usr/local/cuda/bin/nvcc ]]; then export WEIR_CUDA=${WEIR_CUDA:-ON}; fi
fi
targets=(weir weir_tests)
[[ $size == test ]] || targets=() # all, with the benchmarks
[[ $size != full ]] || export WEIR_MANY_FILES=2000 WEIR_KILLS=200 WEIR_TESTS_LEFT_OUT=''
if [[ $size == test ]]; then
  export WEIR_SLOW_TESTS=OFF
  echo "left out: $(grep -vc '^#' tests/slow_tests.txt) tests that take 3 s or more each (tests/slow_tests.txt); tools/test.sh --ci runs most of them"
fi
if build release "${targets[@]}"; then run_tests release; fi
unset WEIR_MANY_FILES WEIR_KILLS WEIR_TESTS_LEFT_OUT
if [[ $size != test ]]; then
  run_asan
  run_core
  run_tsan
fi
if [[ $size == full ]]; then
  run_property_tests
  run_zarrita
  run_yt
  check_tidy
fi

[[ ${#skipped[@]} -eq 0 ]] || printf 'skipped: %s\n' "${skipped[@]}"
[[ ${#failed[@]} -eq 0 ]] || printf 'failed: %s\n' "${failed[@]}"
echo "$passed passed, ${#failed[@]} failed, ${#skipped[@]} skipped"
[[ ${#failed[@]} -eq 0 ]]
