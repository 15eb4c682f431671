#!/bin/sh
# SPDX-License-Identifier: MIT
# streams.sh MICROTIN FOLDER: makes the streams whose decoding is measured: a tile of 2,000 vertices, in each setting
# of decoding, and one whose steps are dear.
set -eu
microtin=$1 folder=$2
here=$(dirname "$0")
mkdir -p "$folder"
"$microtin" fractal --size 257 --seed 1 -o "$folder/tile.asc"
for decoding in quick balanced dense; do
  "$microtin" encode "$folder/tile.asc" --max-vertices 2000 --z-step 16 --coding $decoding \
    -o "$folder/tile_$decoding.mtin" >/dev/null
done
python3 "$here/wheels.py" >"$folder/wheels.xyz"
"$microtin" encode "$folder/wheels.xyz" --max-degree 32 --coding dense -o "$folder/wheels.mtin" >/dev/null
