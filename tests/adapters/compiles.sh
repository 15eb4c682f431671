#!/bin/sh
# SPDX-License-Identifier: MIT
# compiles.sh ONE BUILD: the decoder in one source (in ONE) and the adapters compile without a warning with the options of
# INAV and ArduPilot for an STM32H743, as far as they are about the language and warnings. INAV has C++11 and C99.
set -eu
one=$1 build=$2
cd "$(dirname "$0")/../.."
mkdir -p "$build"
command -v arm-none-eabi-gcc >/dev/null || { echo "skipped: arm-none-eabi-gcc is not installed"; exit 77; }
board="-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard -fno-exceptions -ffunction-sections -fdata-sections"
inav="-O2 -ffast-math -fmerge-all-constants -Wall -Wextra -Wunsafe-loop-optimizations -Wdouble-promotion -Werror"
ardupilot="-O2 -fsingle-precision-constant -Wall -Wextra -Wpointer-arith -Wcast-align -Wundef -Wlogical-op -Werror
  -Wmissing-declarations -Wfloat-equal -Wimplicit-fallthrough -Wmaybe-uninitialized -Wduplicated-cond -Wuse-after-free"

# compile COMPILER SOURCE OPTION...
compile() {
  compiler=$1 source=$2
  shift 2
  # shellcheck disable=SC2086
  "arm-none-eabi-$compiler" $board -I. -I"$one" "$@" -c "$source" -o "$build/compiled.o"
}

# shellcheck disable=SC2086
{
  compile g++ "$one/microtin.cpp" $inav -std=gnu++11
  for standard in 11 17 20; do
    compile g++ "$one/microtin.cpp" $ardupilot -fno-rtti -std=gnu++$standard
  done
  for slots in MESHES COMPACT; do
    compile gcc decoder/adapters/inav.c $inav -Wstrict-prototypes -std=gnu99 -DMICROTIN_ADAPTERS_$slots
    compile gcc decoder/adapters/ardupilot.c $ardupilot -std=gnu99 -DMICROTIN_ADAPTERS_$slots
  done
}
echo "the decoder and the adapters compile as INAV and ArduPilot compile"
