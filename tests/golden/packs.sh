#!/bin/sh
# SPDX-License-Identifier: MIT
# packs.sh MICROTIN FOLDER: makes packs as those of the folder 1.0, which never change; tests/pack/card_test.cpp writes
# what a host answers, tests/pack/tile_digests_test.cpp the digest of each tile.
# card.mtp is for decoder/examples/card.c: a byte of one of its tiles is damaged. tiles.mtp fits into 16 KB of RAM.
set -eu
microtin=$1
here=$2
terrain=$(mktemp -d)
trap 'rm -r "$terrain"' EXIT
"$microtin" fractal --size 385 --seed 20 -o "$terrain/t.asc"
"$microtin" encode "$terrain/t.asc" --max-error 2 --tile-vertices 2500 -o "$here/card.mtp"
size=$(wc -c <"$here/card.mtp")
printf 'damage' | dd of="$here/card.mtp" bs=1 seek=$((size * 2 / 5)) conv=notrunc status=none
"$microtin" encode "$terrain/t.asc" --max-error 30 --tile-vertices 60 -o "$here/tiles.mtp"
# kept.mtp is all kept in 16 KB of RAM: 22 x 22 posts, of which none can be left out.
awk 'BEGIN {
  print "ncols 22\nnrows 22\nxllcenter 0\nyllcenter 0\ncellsize 30"
  for (y = 0; y < 22; ++y)
    for (x = 0; x < 22; ++x) printf "%d%s", (x * x * 37 + y * y * y * 61 + x * y * 17) % 89, x < 21 ? " " : "\n"
}' >"$terrain/k.asc"
"$microtin" encode "$terrain/k.asc" --max-error 0 --tile-vertices 64 --tile-size 7 -o "$here/kept.mtp"
# degree.mtp is for the adapters: in degrees and metres.
"$microtin" fractal --size 129 --seed 4 -o "$terrain/d.asc"
sed -i 's/^cellsize.*/cellsize 0.0008/; s/^xll[a-z]*.*/xllcenter 7.2/; s/^yll[a-z]*.*/yllcenter 43.3/' "$terrain/d.asc"
"$microtin" encode "$terrain/d.asc" --units degree:metre --max-error 8 --tile-vertices 300 -o "$here/degree.mtp"
# pair.mtp has two tiles of four vertices; format-pack.md explains each of its bytes.
cat >"$terrain/p.asc" <<'END'
ncols 5
nrows 3
xllcenter 0
yllcenter 0
cellsize 30
12 14 16 21 26
11 13 15 20 25
10 12 14 19 24
END
"$microtin" encode "$terrain/p.asc" --max-error 0 --tile-size 2 --tile-vertices 64 -o "$here/pair.mtp"
