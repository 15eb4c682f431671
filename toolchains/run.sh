#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh MACHINE IMAGE [OPTION...]: runs a firmware image, with further options for the emulator. Its output
# and exit code become this script's.
machine=$1 image=$2
shift 2

# Runs an emulator, if there is one.
emulate() {
  if ! command -v "$1" >/dev/null; then
    echo "skipped: $1 is not installed"
    exit 1
  fi
  exec timeout 120 "$@" </dev/null
}

escape=$(printf '\033')
bare="-display none -monitor none"
case $machine in
  mps2-* | microbit)
    emulate qemu-system-arm -M "$machine" $bare -serial null -chardev stdio,id=console,signal=off \
      -semihosting-config enable=on,target=native,chardev=console -kernel "$image" "$@" ;;
  virt)
    emulate qemu-system-riscv32 -M virt -bios none $bare -serial stdio -kernel "$image" "$@" ;;
  atmega1284p)
    # simavr colours the lines of the serial port and ends each with a dot.
    emulate simavr -m "$machine" -f 16000000 "$@" "$image" 2>&1 |
      sed -n "s/^.*$escape\[32m\(.*\)\.\$/\1/p; /^skipped: /p" ;;
  s390x) emulate qemu-s390x "$@" "$image" ;;
  i386) emulate "$image" ;;
  node) emulate node "$(dirname "$0")/wasm32/run.js" "$image" ;;
  *)
    echo "there is no machine $machine"
    exit 1 ;;
esac
