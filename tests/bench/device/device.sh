# Part of ../run: what decoding costs on a Cortex-M4, at both levels of optimisation that firmware is
# built with.
entries="microtin_peek microtin_mesh_init microtin_decoder_init microtin_feed microtin_finish"
queries="microtin_height_at microtin_to_lattice microtin_vertex microtin_triangle microtin_neighbour microtin_digest"
prefix=arm-none-eabi

# The device's build at an optimisation, e.g. O2, with a tile of some levels of cells.
build_device() {
  quietly cmake --preset cortex-m4 -B "$build/$1" -DCMAKE_BUILD_TYPE=Level -DCMAKE_CXX_FLAGS_LEVEL="-$1" \
    -DMICROTIN_BENCH=ON -DMICROTIN_BENCH_STREAM="$streams/tile_levels$2.mtin"
  quietly cmake --build "$build/$1" --target bench_device
}

# Bytes of code and constants that some entries add to a firmware, libgcc's part included.
code_bytes() {
  wanted=$(printf -- ' -Wl,-u,%s' $2)
  $prefix-g++ -mcpu=cortex-m4 -mthumb -nostdlib -r -Wl,--gc-sections $wanted \
    "$build/$1/libmicrotin_decoder.a" -lgcc -o "$build/$1/decoder.o"
  $prefix-size "$build/$1/decoder.o" | awk 'NR == 2 { print $1 }'
}

stack_bytes() {
  $prefix-objdump -d "$build/$1/tests/bench/device/bench_device" |
    awk -v entries="$entries" -f tests/bench/device/stack.awk
}

# Vertices, and instructions to decode them.
run_device() {
  sh toolchains/run.sh mps2-an386 "$build/$1/tests/bench/device/bench_device" -icount shift=6
}

printf '\n### Decoding a terrain tile on a Cortex-M4\n\n'
echo "| optimisation | text + rodata, bytes | with queries | stack, bytes | vertices | instructions per vertex, levels 1 | 2 | 3 |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for level in Os O2; do
  row=""
  for cells in 1 2 3; do
    build_device $level $cells
    counts=$(run_device $level)
    set -- $counts
    row="$row $(($2 / $1)) |"
  done
  code=$(code_bytes $level "$entries")
  all=$(code_bytes $level "$entries $queries")
  stack=$(stack_bytes $level)
  echo "| -$level | $code | $all | $stack | $1 |$row"
done
