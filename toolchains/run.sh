#!/bin/sh
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

bare="-display none -monitor none"
case $machine in
  mps2-* | microbit)
    emulate qemu-system-arm -M "$machine" $bare -serial null -chardev stdio,id=console,signal=off \
      -semihosting-config enable=on,target=native,chardev=console -kernel "$image" "$@" ;;
esac
echo "there is no machine $machine"
exit 1
