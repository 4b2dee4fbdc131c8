#!/usr/bin/env bash
# Measures what the README and docs/evaluation.md claim: sizes, errors, ZFP and the paper's method at equal bytes, pictures,
# time and memory. Each finished measurement is a file, so that an interrupted run goes on where it was.
#
#   bench/evaluate.sh [OPTION...] [DIR]       DIR: default build/evaluation, or build/evaluation-quick
#
#   --only NAME,...   these experiments only: sizes, worst_case, errors, few_bytes, lossless, derived,
#                     metrics, zfp, peers, round_trip, pictures, speed, two_passes, stages, headline
#   --again           measure anew what is there already
#   --report          no measurement, only the report of those there are
#   --scale N         divides the extents of the paper's large sets, default 4
#   --full            besides, the large sets at the paper's extents and a cube of 2048^3, where the disk has room:
#                     2.2 times 26 and 46 GB, 43 GB
#   --quick           small volumes only, for the tests: a minute
#   --publish         copies report and pictures to docs/ as well
#   --sperr FILE, --sz3 FILE   the commands sperr3d and sz3, which peers measures; default: on PATH
#   --sperr-commit ID, --sz3-commit ID   what they were built of, for the report
#   --weir FILE       the command to measure; default: build/release/weir, built first
#
# Leaves evaluation.md, evaluation.json, a CSV for each experiment and images/ in DIR. Exit code 1 where a promise is not
# kept: sizes met to the byte, errors below the paper's, noise below its bound, errors below --max-error, by packed
# files too.
set -euo pipefail
cd "$(dirname "$0")/.."
[[ " $* " == *" --weir"* || " $* " == *" --help "* || " $* " == *" --report "* ]] || tools/build.sh release weir
exec python3 -B bench/evaluate "$@"
