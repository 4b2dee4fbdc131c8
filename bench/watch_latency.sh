#!/usr/bin/env bash
# Measures the daemon's latency from the close of a 64 MiB file to the verified output. Compares it with a plain
# `weir convert` of the same file on the same machine in the same run.
#
#   bench/watch_latency.sh [WEIR] [ROUNDS]     default: build/release/weir, 5 rounds
#
# Prints each round and the medians. Exits with 1 if the daemon takes more than 1.3 times the plain conversion plus
# 0.2 s.
set -euo pipefail
cd "$(dirname "$0")/.."
weir=$(realpath "${1:-build/release/weir}")
rounds=${2:-5}

work=$(mktemp -d "${TMPDIR:-/var/tmp}/weir-latency.XXXXXX")
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true; rm -rf "$work"' EXIT
mkdir "$work/in" "$work/out" "$work/plain"
"$weir" sample turbulence --dims 256,256,256 -o "$work/volume.raw" --progress never --log-level warn  # float32: 64 MiB
cat > "$work/weir.toml" <<TOML
[service]
listen = "127.0.0.1:0"
log = "log"
[[watch]]
directory = "in"
output = "out"
watch = "inotify"
thumbnails = false
TOML
"$weir" watch "$work/weir.toml" &
daemon=$!

now() { date +%s.%N; }
calculate() { awk "BEGIN { print $* }"; }
median() { sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
until grep -q ' ready ' "$work/log" 2>/dev/null; do sleep 0.05; done
for ((i = 1; i <= rounds; ++i)); do
  name=v${i}_256x256x256_float32
  begin=$(now)
  "$weir" convert "$work/volume.raw" --dims 256,256,256 --type float32 -o "$work/plain/$i.nvdb" \
    --progress never --log-level warn
  plain=$(calculate "$(now) - $begin")
  cat "$work/volume.raw" > "$work/in/$name.raw"
  begin=$(now)
  until grep -q " done .*$name" "$work/log"; do sleep 0.005; done  # without a thumbnail: verified just now
  daemon_s=$(calculate "$(now) - $begin")
  echo "$plain" >> "$work/plain_s"
  echo "$daemon_s" >> "$work/daemon_s"
  echo "round $i: plain $plain s, daemon $daemon_s s"
done
plain=$(median < "$work/plain_s")
daemon_s=$(median < "$work/daemon_s")
bound=$(calculate "1.3 * $plain + 0.2")
echo "median: plain $plain s, daemon $daemon_s s, at most $bound s asked"
[ "$(calculate "$daemon_s <= $bound")" = 1 ]
