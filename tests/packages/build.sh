#!/bin/sh
# SPDX-License-Identifier: MIT
# build.sh KIND PACKAGES BUILD C C++: builds a package as its ecosystem does, as far as that is here, and runs a program
# that uses it. The ecosystem's own tools for Arduino and Meson; for others stand-ins for their macros, in stand_ins.
set -eu
kind=$1 build=$3 c=$4 cxx=$5
packages=$(cd "$2" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
consumer=$here/../package/consumer.c
library=$packages/$kind/microtin
rm -rf "$build"
mkdir -p "$build"
build=$(cd "$build" && pwd)

need() {
  for tool; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
  done
}

# A CMake project in stand_ins, with the package.
with_cmake() {
  cmake -S "$here/stand_ins/$1" -B "$build/cmake" -G Ninja -DCMAKE_C_COMPILER="$c" -DCMAKE_CXX_COMPILER="$cxx" \
    -DPACKAGE="$library" -DCONSUMER="$consumer" >/dev/null
  cmake --build "$build/cmake" >/dev/null
  "$build/cmake/consumer"
}

case $kind in
  arduino)
    need arduino-builder avr-g++ simavr arm-none-eabi-g++
    hardware=/usr/share/arduino/hardware
    [ -d $hardware/arduino/avr ] || { echo "skipped: arduino-core-avr is not installed"; exit 77; }
    for sketch in "$library"/examples/*/*.ino; do
      name=$(basename "$sketch" .ino)
      mkdir "$build/$name"
      # The core wants a name that this compiler's float.h has for C alone.
      arduino-builder -compile -hardware $hardware -hardware /usr/share/arduino-builder -tools /usr/bin \
        -fqbn arduino:avr:mega:cpu=atmega2560 -prefs compiler.cpp.extra_flags=-DDECIMAL_DIG=__DECIMAL_DIG__ \
        -libraries "$packages/arduino" -build-path "$build/$name" "$sketch" >"$build/log" 2>&1 ||
        { cat "$build/log"; exit 1; }
      echo "$name: $(grep -o 'uses [0-9]* bytes' "$build/log" | head -1)"
    done
    mkdir "$build/uno"
    if arduino-builder -compile -hardware $hardware -hardware /usr/share/arduino-builder -tools /usr/bin \
      -fqbn arduino:avr:uno -prefs compiler.cpp.extra_flags=-DDECIMAL_DIG=__DECIMAL_DIG__ \
      -libraries "$packages/arduino" -build-path "$build/uno" "$library/examples/Height/Height.ino" \
      >"$build/log" 2>&1; then
      echo "an Uno is not refused"
      exit 1
    fi
    grep 'error "microtin needs 48 KB of flash' "$build/log"
    # Cores for Arm compile with C++11 (samd, Adafruit's nrf52) or later standards.
    for standard in gnu++11 gnu++14 gnu++17 gnu++20 gnu++23; do
      arm-none-eabi-g++ -mcpu=cortex-m0plus -mthumb -Os -Wall -Wextra -Wpedantic -Werror -std=$standard -I"$library/src" \
        -c "$library/src/microtin.cpp" -o "$build/library.o"
    done
    timeout 10 simavr -m atmega2560 -f 16000000 "$build/Height/Height.ino.elf" >"$build/said" 2>&1 || true
    grep -o '6 vertices, height 25' "$build/said"
    ;;
  platformio)
    # Sources of srcDir, headers of includeDir, for each of the frameworks' standards.
    for standard in c++11 gnu++11 gnu++14 gnu++17 gnu++20; do
      $cxx -O2 -std=$standard -Wall -Wextra -Werror -c -I"$library/src" "$library/src/microtin.cpp" -o "$build/library.o"
    done
    $c -c -I"$library/src" "$consumer" -o "$build/consumer.o"
    $cxx "$build/consumer.o" "$build/library.o" -o "$build/consumer"
    "$build/consumer"
    ;;
  esp-idf)
    with_cmake esp_idf
    if cmake -S "$here/stand_ins/esp_idf" -B "$build/older" -G Ninja -DCMAKE_C_COMPILER="$c" -DCMAKE_CXX_COMPILER="$cxx" \
      -DPACKAGE="$library" -DCONSUMER="$consumer" -DIDF_VERSION_MAJOR=4 -DIDF_VERSION_MINOR=3 >"$build/log" 2>&1; then
      echo "ESP-IDF 4.3 is not refused"
      exit 1
    fi
    grep -q 'ESP-IDF 4.4 or later; this is 4.3' "$build/log"
    ;;
  zephyr)
    for python in python3 /usr/bin/python3 none; do
      $python -c 'import kconfiglib' 2>/dev/null && break
    done
    [ "$python" != none ] || { echo "skipped: kconfiglib is not installed"; exit 77; }
    for choice in 'MICROTIN=y 64BIT=y' 'MICROTIN=y 64BIT=y MICROTIN_NAMES=n' 'MICROTIN=y MICROTIN_INDEX_BITS_32=y' \
      'MICROTIN=y MICROTIN_VOIDS=n MICROTIN_ONLY_QUICK=y' 'MICROTIN=y MICROTIN_ONLY_BALANCED=y'; do
      # shellcheck disable=SC2086
      $python "$here/stand_ins/zephyr/configure.py" "$library/zephyr/Kconfig" "$build/config.cmake" $choice
      cmake -E rm -rf "$build/cmake"
      CONFIG=$build/config.cmake with_cmake zephyr
    done
    ;;
  cmsis-pack)
    # What the description names, for a Cortex-M4, by gcc and by the compiler on which Keil's is built.
    need arm-none-eabi-gcc arm-none-eabi-g++ clang++
    cortex="-mcpu=cortex-m4 -mthumb -Os -ffreestanding"
    sources=$(sed -n 's/.*category="source" name="\([^"]*\)".*/\1/p' "$library"/*.pdsc)
    includes=$(sed -n 's/.*category="include" name="\([^"]*\)".*/\1/p' "$library"/*.pdsc)
    for source in $sources; do
      # shellcheck disable=SC2086
      arm-none-eabi-g++ -std=c++14 $cortex -I"$library/$includes" -c "$library/$source" -o "$build/gcc.o"
      # shellcheck disable=SC2086
      clang++ --target=arm-none-eabi -std=c++14 $cortex -I"$library/$includes" -c "$library/$source" -o "$build/clang.o"
    done
    # shellcheck disable=SC2086
    arm-none-eabi-gcc $cortex -I"$library/$includes" -c "$consumer" -o "$build/consumer.o"
    arm-none-eabi-nm "$build/gcc.o" | grep -q ' T microtin_read_stream_info_16'
    arm-none-eabi-nm "$build/consumer.o" | grep -q ' U microtin_read_stream_info_16'
    ;;
  meson)
    need meson ninja
    mkdir -p "$build/project/subprojects"
    left_out=""
    cp "$here/stand_ins/meson/meson.build" "$consumer" "$build/project"
    cp -r "$packages/meson/." "$build/project/subprojects"
    for width in platform 16; do
      # shellcheck disable=SC2086
      CC=$c CXX=$cxx meson setup -Dmicrotin:index_bits=$width $left_out "$build/$width" "$build/project" >"$build/log" ||
        { cat "$build/log"; exit 1; }
      ninja -C "$build/$width" >"$build/log" || { cat "$build/log"; exit 1; }
      "$build/$width/consumer"
      left_out="-Dmicrotin:names=false -Dmicrotin:voids=false -Dmicrotin:codings=only_balanced"
    done
    ;;
esac
echo "$kind: built"
