#!/bin/sh
# SPDX-License-Identifier: MIT
# rings.sh [SEEDS]: looks for the worst compact terrain among the meshes of rings.py, each made with SEEDS seeds (3).
# Prints for each the vertices, the bytes a vertex without the header of 88, and the most expensive height on a straight
# path and from far on a Cortex-M4 at -Os, in instructions and compared with the mesh's most expensive; then the worst
# of each. If the encoder refuses a mesh, prints the bytes alone. Needs build/release/microtin, or another in MICROTIN.
set -eu
cd "$(dirname "$0")/../.."
seeds=${1:-3} microtin=${MICROTIN:-build/release/microtin}
work=$PWD/build/rings
mkdir -p "$work/streams"
for name in tile_quick tile_balanced tile_dense wheels; do
  cp tests/golden/1.0/example.mtin "$work/streams/$name.mtin" # only tile_balanced is used
done
cmake --preset cortex-m4 -B "$work/build" -DMICROTIN_FOOTPRINT_STREAMS="$work/streams" >"$work/log"

measure() { # NAME
  if ! "$microtin" encode "$work/mesh.xyz" --max-degree 32 -o "$work/streams/tile_balanced.mtin" >"$work/log" 2>&1; then
    sed -n "s/.*it takes \([0-9]*\) bytes.* for \([0-9]*\) vertices.*/\1 \2/p" "$work/log" |
      awk -v name="$1" '{ printf "%-19s %5d %6.2f refused\n", name, $2, ($1 - 88) / $2 }'
    return
  fi
  vertices=$("$microtin" info "$work/streams/tile_balanced.mtin" | sed -n 's/^vertices: //p')
  cmake --build "$work/build" --target measure.Os.tile_balanced >"$work/log"
  sh toolchains/run.sh mps2-an386 "$work/build/tests/footprint/measure.Os.tile_balanced" -icount shift=6 |
    awk -v name="$1" -v n="$vertices" '
      { value[$1] = $2 }
      END {
        path = value["compact_warm_worst"]
        far = value["compact_far_worst"]
        printf "%-19s %5d %6.2f %6d %5.2f %6d %5.2f\n", name, n, (value["compact_bytes"] - 88) / n, path,
               path / value["warm_worst"], far, far / value["far_worst"]
      }'
}

echo "mesh, seed       vertices  bytes   path         far"
python3 tests/footprint/rings.py | while read -r kind; do
  for seed in $(seq "$seeds"); do
    python3 tests/footprint/rings.py "$kind" "$seed" >"$work/mesh.xyz"
    measure "$kind, $seed"
  done
done | tee "$work/found"
echo "the worst of each:"
for column in 3 4 5 6 7; do # of what follows the name
  awk -v column=$((column - 1)) '{ line = $0; sub(/.*, /, ""); if ($(column + 1) + 0 > most) { most = $(column + 1); worst = line } }
    END { print worst }' "$work/found"
done
