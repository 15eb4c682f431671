#!/bin/sh
# SPDX-License-Identifier: MIT
# streams.sh MICROTIN FOLDER: makes the streams whose decoding is measured: a tile of 2,000 vertices, in each number
# of levels, and one whose steps are dear.
set -eu
microtin=$1 folder=$2
here=$(dirname "$0")
mkdir -p "$folder"
"$microtin" fractal --size 257 --seed 1 -o "$folder/tile.asc"
for levels in 1 2 3; do
  "$microtin" encode "$folder/tile.asc" --max-vertices 2000 --z-step 16 --levels $levels \
    -o "$folder/tile_levels$levels.mtin" >/dev/null
done
python3 "$here/wheels.py" >"$folder/wheels.xyz"
"$microtin" encode "$folder/wheels.xyz" --degree 32 --levels 3 -o "$folder/wheels.mtin" >/dev/null
