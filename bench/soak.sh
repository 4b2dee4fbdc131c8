#!/usr/bin/env bash
# Soak test of the daemon. Writes, renames and rewrites FILES small volumes while the daemon runs, and deletes one in
# ten after its conversion. Prints resident memory, descriptors and threads of the daemon every 500 files, and
# compares the first figures with the last.
#
#   bench/soak.sh [WEIR] [FILES]     default: build/release/weir, 5000 files
#
# Exits with 1 if an output is missing or wrong, memory grew by more than a quarter and 8 MiB, or descriptors or
# threads grew at all.
set -euo pipefail
cd "$(dirname "$0")/.."
weir=$(realpath "${1:-build/release/weir}")
files=${2:-5000}

work=$(mktemp -d "${TMPDIR:-/var/tmp}/weir-soak.XXXXXX")
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true; rm -rf "$work"' EXIT
mkdir "$work/in" "$work/out"
cat > "$work/weir.toml" <<TOML
[service]
listen = "127.0.0.1:0"
port_file = "port"
log = "log"
jobs = 2
threads = 1
[[watch]]
directory = "in"
output = "out"
settle = 0.2
thumbnails = false
TOML
"$weir" sample cloud --dims 16,16,16 -o "$work/volume_16x16x16_float32.raw" --progress never --log-level warn
"$weir" convert "$work/volume_16x16x16_float32.raw" -o "$work/expected.nvdb" --progress never --log-level warn
"$weir" watch "$work/weir.toml" &
daemon=$!
until [ -s "$work/port" ]; do sleep 0.05; done

field() { awk -v key="$1:" '$1 == key { print $2 }' "/proc/$daemon/status"; }
figures() { echo "$(field VmRSS) $(find "/proc/$daemon/fd" -type l | wc -l) $(field Threads)"; }
first=
begin=$(date +%s)
for ((i = 1; i <= files; ++i)); do
  name=f${i}_16x16x16_float32.raw
  case $((i % 3)) in
    0) cat "$work/volume_16x16x16_float32.raw" > "$work/in/$name" ;;
    1) cp "$work/volume_16x16x16_float32.raw" "$work/in/.$name" && mv "$work/in/.$name" "$work/in/$name" ;;
    2) head -c 5000 "$work/volume_16x16x16_float32.raw" > "$work/in/$name"
       cat "$work/volume_16x16x16_float32.raw" > "$work/in/$name" ;;
  esac
  if ((i % 500 == 0 || i == files)); then
    until [ "$(compgen -G "$work/out/*.nvdb" | wc -l)" -ge "$i" ]; do sleep 0.2; done
    sleep 1  # what is idle, not what happens to be open
    last=$(figures)
    [ -n "$first" ] || first=$last
    echo "$i files, $(($(date +%s) - begin)) s: RSS KiB, descriptors, threads: $last"
    rm -f "$work"/in/f*0_16x16x16_float32.raw
  fi
done
wrong=0
for ((i = 1; i <= files; ++i)); do
  cmp -s "$work/out/f${i}_16x16x16_float32.nvdb" "$work/expected.nvdb" || wrong=$((wrong + 1))
done
echo "$wrong of $files outputs are missing or wrong; $(grep -c ' start ' "$work"/log*  | awk -F: '{ s += $NF } END { print s }') conversions"
read -r rss_first fd_first threads_first <<< "$first"
read -r rss_last fd_last threads_last <<< "$last"
((wrong == 0 && rss_last <= rss_first * 5 / 4 + 8192 && fd_last <= fd_first && threads_last <= threads_first))
