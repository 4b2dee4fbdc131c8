#!/usr/bin/env bash
# Measures the GPU of this machine: checks the CUDA part, then prints tables of loading, decoding, frames per second
# against a dense texture, and whole pictures. Needs a CUDA device. The steps `largest` and `cold` need 50 GB of disk
# and 25 GB of memory, `giant` needs 75 GB of disk.
#
#   bench/gpu.sh [--bin DIR] [--edge N] [STEP...]
#     --bin    a folder with weir, weir_tests_cuda and weir_bench_{load,decode,encode,save,frames,paging}; default: build/release, built
#     --edge   of the cloud of cold and largest, default 2048
#     STEP     checks, load, decode, encode, save, threads, frames, paging, pictures, cold, largest, giant; default: all
#              but the last
#
# Exit code 1 where a check fails, or loading is below 0.8 of the device's rate.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=
edge=2048
while [[ ${1:-} == --* ]]; do
  case $1 in
    --bin) bin=$2 ;;
    --edge) edge=$2 ;;
    *) sed -n '6,10s/^# *//p' "$0" >&2; exit 2 ;;
  esac
  shift 2
done
[ $# -gt 0 ] || set -- checks load decode encode save threads frames paging pictures cold largest
for step; do
  case $step in
    checks | load | decode | encode | save | threads | frames | paging | pictures | cold | largest | giant) ;;
    *) sed -n '6,10s/^# *//p' "$0" >&2; exit 2 ;;
  esac
done
if [ -z "$bin" ]; then
  tools/build.sh release weir weir_tests_cuda weir_bench_{load,decode,encode,save,frames,paging}
  mkdir -p build/gpu
  for name in weir weir_tests_cuda bench/weir_bench_{load,decode,encode,save,frames,paging}; do
    ln -sf "../release/$name" "build/gpu/${name##*/}"
  done
  bin=build/gpu
fi
bin=$(realpath "$bin")
work=$(mktemp -d "${TMPDIR:-/tmp}/weir-gpu.XXXXXX")
trap 'rm -rf "$work"' EXIT

# A failure is recorded as a file, because variables that subshells set are lost.
fail() { : >"$work/.failed"; }
quiet() { "$@" --progress never --log-level error; }
# volume KIND EDGE ENCODING BUDGET...: makes KINDEDGE.ENCODING.nvdb in the work folder, and KINDEDGE.raw if missing.
volume() {
  local dims=$2,$2,$2 name=$work/$1$2
  [ -e "$name.raw" ] || quiet "$bin/weir" sample "$1" --dims "$dims" -o "$name.raw"
  quiet "$bin/weir" convert "$name.raw" --dims "$dims" --type float32 --memory 8GiB --encoding "$3" "${@:4}" \
    -o "$name.$3.nvdb"
}
# table KIND EDGE ARGUMENTS...: prints frames per second of KINDEDGE.float.nvdb, .fpn.nvdb and .packed.nvdb.
table() {
  local name=$work/$1$2
  echo "== $1 $2"
  "$bin/weir_bench_frames" "$name.raw" "$2,$2,$2" "$name.float.nvdb" "$name.fpn.nvdb" "$name.packed.nvdb" "${@:3}" ||
    fail
  rm "$name".*
}
# The leaves have an eighth of the dense size, the packed file a twentieth.
cloud() {
  volume cloud "$1" float --rate 8
  volume cloud "$1" fpn --rate 8
  volume cloud "$1" packed --rate 20
  table cloud "$@"
}
# Files that keep all leaves, because noise without some leaves gives a different picture. The quantised file has 8 to
# 16 bits per voxel, the packed file 16.
noise() {
  volume noise "$1" float --lossless
  volume noise "$1" fpn --rate 1.9
  volume noise "$1" packed --rate 2
  table noise "$@"
}
# picture NAME ARGUMENTS: prints the seconds of a picture of 1024 x 1024 pixels.
picture() {
  "$bin/weir" render "$work/cloud1024.float.nvdb" -o "$work/p.png" --overwrite --size 1024x1024 --json --progress never \
    --log-level error "${@:2}" >"$work/p.json" || fail
  printf '%-44s %s\n' "$1" "$(grep -E '"(render_s|way)"' "$work/p.json" | tr -d '\n' | tr -s ' ')"
}
devices() { nvidia-smi --query-gpu=index --format=csv,noheader | wc -l; }

checks() {
  timeout 300 "$bin/weir_tests_cuda" --gtest_brief=1 --gtest_filter=-RefusedMemory.*:PagingLeaks.* || fail
  echo "memory refused at any moment; a thousand loads and evictions"
  timeout 500 "$bin/weir_tests_cuda" --gtest_brief=1 --gtest_filter=RefusedMemory.*:PagingLeaks.* || fail
  # Repeated, because the threads of a load interleave differently each time.
  timeout 300 "$bin/weir_tests_cuda" --gtest_brief=1 --gtest_repeat=30 --gtest_break_on_failure \
    --gtest_filter='GridLoader.Every*:GridLoader.Reuses*:GridLoader.Stops*' >"$work/log" || { tail "$work/log"; fail; }
  command -v compute-sanitizer >/dev/null || { echo "compute-sanitizer: not found, skipped"; return 0; }
  for tool in memcheck racecheck synccheck; do
    echo "compute-sanitizer $tool"
    timeout 300 compute-sanitizer --tool "$tool" --error-exitcode 9 "$bin/weir_tests_cuda" --gtest_brief=1 \
      --gtest_filter='*DeviceTable*:DeviceMacrocells.*:CudaBackendTest.MarchedPicturesAreTheCpus:CudaBackendTest.Samples*:BlockDecoderTest.*:DeviceCoder.*:ResidentVolume.*:BrickVolumeTest.ASmall*:BrickVolumeTest.Levels*:ExpandedGridTest.*' |
      tail -n 3 || fail
  done
  echo "compute-sanitizer memcheck, memory refused"
  timeout 300 compute-sanitizer --tool memcheck --error-exitcode 9 "$bin/weir_tests_cuda" --gtest_brief=1 \
    --gtest_filter='RefusedMemory.OfAllBricks_AllFromOneOn' | tail -n 3 || fail
}

load() {
  volume noise 1024 float --rate 1
  rm "$work/noise1024.raw"
  "$bin/weir_bench_load" "$work/noise1024.float.nvdb" || fail
  rm "$work"/noise1024.*
}

# packed KIND RATE...: makes the packed files KIND512.RATE.nvdb.
packed() {
  for rate in "${@:2}"; do
    volume "$1" 512 packed --rate "$rate" --preview off
    mv "$work/${1}512.packed.nvdb" "$work/${1}512.$rate.nvdb"
    rm "$work/${1}512.packed.nvdb.json"
  done
  rm "$work/${1}512.raw"
}

# Measures survey and encoding of 1024^3 values, then the command with both backends, which must make the same bytes.
encode() {
  "$bin/weir_bench_encode" || fail
  for what in "cloud 20" "cloud 8" "turbulence 8"; do
    local kind=${what% *} name=$work/${what% *}1024
    [ -e "$name.raw" ] || quiet "$bin/weir" sample "$kind" --dims 1024,1024,1024 -o "$name.raw"
    for backend in cpu cuda cpu cuda; do
      "$bin/weir" convert "$name.raw" --dims 1024,1024,1024 --type float32 --memory 6GiB --encoding packed \
        --rate "${what#* }" --backend "$backend" -o "$name.$backend.nvdb" --overwrite --resume off --json --progress never \
        --log-level error >"$work/c.json" || fail
      sed -nE "s/.*\"survey_s\": *([0-9.]+).*\"total_s\": *([0-9.]+).*\"peak_rss_bytes\": *([0-9]+).*/\\2 \\1 \\3/p" "$work/c.json" |
        awk -v what="$what, --backend $backend" '{ printf "%-32s %.2f s, survey %.2f, %d MiB\n", what, $1, $2, $3 / 1048576 }'
    done
    cmp "$name.cpu.nvdb" "$name.cuda.nvdb" || fail
    rm "$name".c*
    [ "$what" = "cloud 20" ] || rm "$name".*
  done
}

# converted ARGUMENTS...: prints the seconds of a conversion of the 1024^3 cloud: survey, total and selection.
converted() {
  "$bin/weir" convert "$work/cloud1024.raw" --dims 1024,1024,1024 --type float32 --memory 32GiB --rate 20 --backend cpu --resume off \
    -o "$work/cloud1024.nvdb" --overwrite --trace "$work/t.json" --json --progress never --log-level error "$@" \
    >"$work/c.json" || fail
  sed -nE 's/.*"survey_s": *([0-9.]+).*"total_s": *([0-9.]+).*/\1 \2/p' "$work/c.json" | tr '\n' ' '
  sed -nE 's/.*"name":"select".*"dur":([0-9.]+).*/\1/p' "$work/t.json" | awk '{ sum += $1 } END { print sum / 1e6 }'
}
# Measures whole conversions with 1, 2, 4 ... threads, the best of three, and one read of the file.
threads() {
  local name=$work/cloud1024.raw
  quiet "$bin/weir" sample cloud --dims 1024,1024,1024 -o "$name"
  printf '== conversions of cloud 1024 to a twentieth; reading it once: %s\n' "$(seconds dd if="$name" of=/dev/null bs=8M)"
  for encoding in float fpn packed; do
    for ((n = 1; n <= $(nproc); n *= 2)); do
      for ((run = 0; run < 3; ++run)); do
        converted --encoding "$encoding" --threads "$n"
      done | awk -v what="$encoding, $n threads" 'NR == 1 || $2 < best { best = $2; survey = $1; select = $3 }
          END { printf "%-20s %6.2f s, survey %5.2f, rest %5.2f, of that selection %5.3f\n", what, best, survey, best - survey, select }'
    done
  done
  rm "$work"/*
}

decode() {
  packed cloud 20 53.3
  packed turbulence 10.667 20 50
  packed noise 2 5.33
  "$bin/weir_bench_decode" "$work"/*512.*.nvdb || fail
  rm "$work"/*
}

frames() {
  cloud 256
  cloud 512
  cloud 1024 --cells 32,16,64
  noise 256
  noise 512
  noise 1024
}

paging() {
  volume cloud 1024 packed --rate 20
  "$bin/weir_bench_paging" "$work/cloud1024.packed.nvdb" --mode path --frames 12 || fail  # 12, since they are long
  for mode in dvr iso mip; do
    "$bin/weir_bench_paging" "$work/cloud1024.packed.nvdb" --mode "$mode" --frames 36 || fail
  done
  "$bin/weir_bench_paging" "$work/cloud1024.packed.nvdb" --frames 36 --scattered 3 || fail
  for mode in dvr iso mip; do
    "$bin/weir_bench_paging" "$work/cloud1024.packed.nvdb" --mode "$mode" --frames 36 --lod 2 || fail
  done
  rm "$work"/*
}

pictures() {
  volume cloud 1024 float --rate 8
  # A Radiance picture of 16 x 8 pixels: a sky, with a sun 2^10 times as bright in one pixel.
  {
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n'
    for ((i = 0; i < 128; ++i)); do
      if [ "$i" = 37 ]; then printf '\200\200\200\213'; else printf '\200\200\200\201'; fi
    done
  } >"$work/sky.hdr"
  printf '[lighting]\nenvironment = "sky.hdr"\nbackground = "environment"\n' >"$work/sky.toml"
  echo "== whole pictures of cloud 1024, 256 samples a pixel, path tracing, seconds"
  picture "stochastic, plain scene" --spp 256 --filter stochastic
  picture "stochastic, environment" --spp 256 --filter stochastic --scene "$work/sky.toml"
  picture "trilinear atlas, plain scene" --spp 256
  for ((n = 2; n <= $(devices); n *= 2)); do
    picture "stochastic, plain scene, $n devices" --spp 256 --filter stochastic --devices "$(seq -s , 0 $((n - 1)))"
    picture "stochastic, plain scene, 2048 samples, 1 device" --spp 2048 --filter stochastic
    picture "stochastic, plain scene, 2048 samples, $n devices" --spp 2048 --filter stochastic \
      --devices "$(seq -s , 0 $((n - 1)))"
  done
  rm "$work"/*
}

# forget FILE: drops it from the page cache.
forget() { sync "$1" && dd if="$1" iflag=nocache count=0 status=none; }
# seconds COMMAND...: prints how long COMMAND takes.
seconds() {
  local start
  start=$(date +%s.%N)
  "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail; }
  awk -v a="$start" -v b="$(date +%s.%N)" 'BEGIN { printf "%.2f s\n", b - a }'
}

cold() {
  local file=$work/cloud$edge.packed.nvdb
  volume cloud "$edge" packed --rate 20
  rm "$work/cloud$edge.raw"
  echo "== cloud $edge, $(stat -c %s "$file") bytes, from the disk"
  forget "$file"
  printf 'reading the file           %s' "$(seconds cat "$file")"; echo
  for mode in dvr path; do
    forget "$file"
    printf 'weir render --mode %-4s    %s' $mode "$(seconds "$bin/weir" render "$file" -o "$work/p.png" --mode $mode \
      --size 1024x1024 --json --progress never --log-level error)"
    grep -E '"(load_s|render_s)"' "$work/log" | tr -d '\n' | tr -s ' '; echo
    rm "$work/p.png"
  done
  echo "== the same, 360 x 270 pixels, seconds of rendering: all bricks; 2 GiB of device memory; 2 GiB, --lod 2"
  for mode in "path --spp 32" dvr iso mip; do
    printf '%-16s' "$mode"
    smaller "$file" "$mode"
    smaller "$file" "$mode" --device-memory 2GiB
    smaller "$file" "$mode" --device-memory 2GiB --lod 2
    echo
  done
  rm "$work"/*
}
# smaller FILE MODE ARGUMENTS...: prints the seconds of a small picture.
smaller() {
  local mode
  read -ra mode <<<"$2"
  timeout 300 "$bin/weir" render "$1" -o "$work/p.png" --overwrite --mode "${mode[@]}" --size 360x270 --json --progress never \
    --log-level error "${@:3}" >"$work/p.json" || fail
  printf '%9.3f' "$(sed -nE 's/.*"render_s": *([0-9.]+).*/\1/p' "$work/p.json")"
}

# A volume larger than any device's memory: 4096^3 voxels of uint8, lossless.
giant() {
  local name=$work/cloud4096
  quiet "$bin/weir" sample cloud --dims 4096,4096,4096 --type uint8 -o "$name.raw"
  printf '== cloud 4096, uint8, packed without loss: %s, ' "$(seconds "$bin/weir" convert "$name.raw" --dims 4096,4096,4096 \
    --type uint8 --memory 4GiB --encoding packed --lossless -o "$name.nvdb" --progress never --log-level error)"
  rm "$name.raw"
  printf '%s bytes; seconds of rendering with 2 GiB of device memory, and --lod 3\n' "$(stat -c %s "$name.nvdb")"
  for mode in "path --spp 8" dvr iso mip; do
    printf '%-16s' "$mode"
    smaller "$name.nvdb" "$mode" --device-memory 2GiB
    smaller "$name.nvdb" "$mode" --device-memory 2GiB --lod 3
    echo
  done
  rm "$work"/*
}

nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader
for step; do
  case $step in
    checks) checks ;;
    load) load ;;
    decode) decode ;;
    encode) encode ;;
    save) "$bin/weir_bench_save" || fail ;;
    frames) frames ;;
    paging) paging ;;
    pictures) pictures ;;
    threads) threads ;;
    cold) cold ;;
    giant) giant ;;
    largest) cloud "$edge" ;;
  esac
done
[ ! -e "$work/.failed" ]
