#!/usr/bin/env bash
# The GPU's figures on this machine: checks the CUDA part, then prints one table of loading and one of frames a second
# against a dense texture. Needs a CUDA device, and for the largest volume 40 GB of memory and of disk.
#
#   bench/gpu.sh [BIN] [LARGEST]     BIN: a folder with weir, weir_tests_cuda, weir_bench_load and weir_bench_frames,
#                                    default: build/release, built first; LARGEST: edge of the largest cloud, default 2048
#
# Exit code 1 where a check fails, or loading is below 0.8 of the device's rate.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=${1:-}
largest=${2:-2048}
if [ -z "$bin" ]; then
  tools/build.sh release weir weir_tests_cuda weir_bench_load weir_bench_frames
  mkdir -p build/gpu
  for name in weir weir_tests_cuda bench/weir_bench_load bench/weir_bench_frames; do
    ln -sf "../release/$name" "build/gpu/${name##*/}"
  done
  bin=build/gpu
fi
bin=$(realpath "$bin")
work=$(mktemp -d "${TMPDIR:-/tmp}/weir-gpu.XXXXXX")
trap 'rm -rf "$work"' EXIT
failed=0

quiet() { "$@" --progress never --log-level warn; }
# volumes KIND EDGE: KINDEDGE.raw and, at rate 8, KINDEDGE.f.nvdb and .n.nvdb (quantised) in the work folder.
volumes() {
  local dims=$2,$2,$2 name=$work/$1$2
  quiet "$bin/weir" sample "$1" --dims "$dims" -o "$name.raw"
  quiet "$bin/weir" convert "$name.raw" --dims "$dims" --type float32 --rate 8 --memory 8GiB --encoding float -o "$name.f.nvdb"
  quiet "$bin/weir" convert "$name.raw" --dims "$dims" --type float32 --rate 8 --memory 8GiB --encoding fpn -o "$name.n.nvdb"
}
frames() {
  volumes "$1" "$2"
  "$bin/weir_bench_frames" "$work/$1$2.raw" "$2,$2,$2" "$work/$1$2.f.nvdb" "$work/$1$2.n.nvdb" "${@:3}" || failed=1
  rm "$work/$1$2".*
}

nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader
timeout 300 "$bin/weir_tests_cuda" --gtest_brief=1 || failed=1
if command -v compute-sanitizer >/dev/null; then
  for tool in memcheck racecheck; do
    echo "compute-sanitizer $tool"
    timeout 300 compute-sanitizer --tool "$tool" --error-exitcode 9 "$bin/weir_tests_cuda" --gtest_brief=1 \
      --gtest_filter='*DeviceTable*:DeviceMacrocells.*:CudaBackendTest.MarchedPicturesAreTheCpus:CudaBackendTest.Samples*' |
      tail -n 3 || failed=1
  done
fi

dims=1024,1024,1024
quiet "$bin/weir" sample noise --dims $dims -o "$work/noise.raw"
quiet "$bin/weir" convert "$work/noise.raw" --dims $dims --type float32 --rate 1 --memory 8GiB --encoding float -o "$work/noise.nvdb"
rm "$work/noise.raw"
"$bin/weir_bench_load" "$work/noise.nvdb" || failed=1
rm "$work/noise.nvdb"

frames cloud 256
frames cloud 512
frames cloud 1024 --cells 32,16,64
frames noise 512
frames noise 1024
frames cloud "$largest"
exit "$failed"
