#!/usr/bin/env bash
# Goes from a fresh checkout to a picture: installs the packages that weir needs, builds the command, makes a cloud,
# converts the cloud to an eighth of its size, verifies the file and renders it. The results go to demo/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

echo "1/3 packages"
tools/setup.sh build
echo "2/3 building build/release/weir (the first time some minutes; log: build/release/build.log)"
tools/build.sh command weir

echo "3/3 a cloud: made, converted, verified, rendered"
weir=build/release/weir
volume=demo/cloud_256x256x256_float32.raw
mkdir -p demo

[[ -s $volume ]] || "$weir" sample cloud --dims 256,256,256 -o "$volume"
"$weir" convert "$volume" --rate 8 -o demo/cloud.nvdb --overwrite
"$weir" verify demo/cloud.nvdb
"$weir" inspect demo/cloud.nvdb
"$weir" render demo/cloud.nvdb -o demo/cloud.png --size 640x480 --spp 32 --colormap white --overwrite

cat <<TEXT

The volume                    $PWD/$volume
an eighth of it as NanoVDB    $PWD/demo/cloud.nvdb
what that lost, in numbers    $PWD/demo/cloud.nvdb.json
and how it looks              $PWD/demo/cloud.png
TEXT
