#!/usr/bin/env bash
# The checks: tools/test.sh [--quick|--full]
#   as CI runs them: the tests of the release build, a short run of each fuzzer, clang-format, shellcheck.
#   --quick: the tests of the release build only.
#   --full: besides, the tests of the AddressSanitizer + UndefinedBehaviorSanitizer build and, where threads run, of
#   the ThreadSanitizer build, and clang-tidy; three more builds of everything, an hour on two cores.
# Logs are in build/checks/. The last line is `N passed, N failed, N skipped`; failed and skipped checks are named
# above it. Exits with 1 where anything failed.
#   WEIR_FUZZ_SECONDS   for each fuzzer, default 15
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quick=false
full=false
case ${1-} in
  '') ;;
  --quick) quick=true ;;
  --full) full=true ;;
  *)
    echo "tools/test.sh: unknown option '$1': there are --quick and --full" >&2
    exit 2
    ;;
esac

export PATH=/usr/lib/llvm-14/bin:$PATH
logs=build/checks
rm -rf "$logs"
mkdir -p "$logs"
passed=0
failed=()
skipped=()

# check NAME COMMAND...: one check, its output kept and shown only where it fails; returns whether it passed.
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

# names_with STATUS JUNIT: the test cases of that status.
names_with() { sed -n "s/.*<testcase name=\"\([^\"]*\)\".* status=\"$1\".*/\1/p" "$2"; }

# run_tests PRESET [COMMAND...]: builds the preset and counts each of its tests; COMMAND runs ctest.
run_tests() {
  local preset=$1 junit=$PWD/$logs/$1.xml log=$logs/$1.log
  shift
  check "build of $preset" tools/build.sh "$preset" || return 0
  "$@" ctest --preset "$preset" --parallel "$(nproc)" --output-junit "$junit" >"$log" 2>&1 || true
  if [[ ! -s $junit ]]; then
    failed+=("$preset tests")
    tail -n 60 "$log"
    return 0
  fi
  passed=$((passed + $(names_with run "$junit" | wc -l)))
  local name
  while read -r name; do failed+=("$preset $name"); done < <(names_with fail "$junit")
  while read -r name; do skip "$preset $name" "see $log"; done < <(names_with notrun "$junit")
  if [[ -n $(names_with fail "$junit") ]]; then
    echo "--- $preset tests failed; from $log:"
    grep -v -E '^ *[0-9]+/[0-9]+ Test|Passed|^ *Start ' "$log" | tail -n 200
  fi
}

run_tsan() {
  # The sanitizer's shadow memory needs less address randomisation than some kernels use.
  if setarch "$(uname -m)" -R true 2>/dev/null; then
    run_tests tsan setarch "$(uname -m)" -R
  else
    run_tests tsan
  fi
}

run_fuzzers() {
  if ! has clang++ || ! compgen -G "$(clang++ -print-resource-dir)/lib/*/libclang_rt.fuzzer*" >/dev/null; then
    skip fuzzers "clang's libFuzzer is not installed"
    return 0
  fi
  check "build of fuzz" tools/build.sh fuzz || return 0
  local fuzzer name corpus
  for fuzzer in build/fuzz/fuzz/*; do
    name=${fuzzer##*/}
    corpus=build/fuzz/corpus/$name
    mkdir -p "$corpus"
    local seeds=tests/fuzz/corpus/$name
    [[ -d $seeds ]] || seeds=
    # New inputs are kept in the first folder; the seeds only start the search.
    check "fuzz $name" "$fuzzer" -max_total_time="${WEIR_FUZZ_SECONDS:-15}" -timeout=10 -rss_limit_mb=2048 \
      -artifact_prefix="$logs/" "$corpus" ${seeds:+"$seeds"} || true
  done
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
  check shellcheck shellcheck tools/*.sh bench/*.sh .ci/run packaging/postinst packaging/prerm || true
}

check_tidy() {
  if ! has clang-tidy; then
    skip clang-tidy "not installed"
    return 0
  fi
  # A build, so only files that changed, or whose headers did, are looked at again.
  check clang-tidy tools/build.sh tidy || true
}

check setup tools/setup.sh || true
exec </dev/null
run_tests release
if ! $quick; then
  check_format
  check_shell
  run_fuzzers
fi
if $full; then
  run_tests asan
  run_tsan
  check_tidy
fi

[[ ${#skipped[@]} -eq 0 ]] || printf 'skipped: %s\n' "${skipped[@]}"
[[ ${#failed[@]} -eq 0 ]] || printf 'failed: %s\n' "${failed[@]}"
echo "$passed passed, ${#failed[@]} failed, ${#skipped[@]} skipped"
[[ ${#failed[@]} -eq 0 ]]
