#!/bin/sh
# SPDX-License-Identifier: MIT
# parallel.sh MICROTIN: shards that GNU parallel makes join to the bytes of a single run.
set -eu
command -v parallel >/dev/null || { echo "skipped: parallel is not installed"; exit 77; }
microtin=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
options="--max-error 10 --fast --tile-vertices 100"
"$microtin" fractal --size 129 --seed 3 -o area.asc
"$microtin" encode area.asc $options -o single.mtp
"$microtin" plan area.asc $options --shards 5 >shards
parallel --halt now,fail=1 "'$microtin' encode area.asc $options {=uq=} -o {#}.shard" :::: shards
"$microtin" merge ./*.shard -o area.mtp
cmp single.mtp area.mtp
echo "$(ls ./*.shard | wc -l) shards, the same bytes"
