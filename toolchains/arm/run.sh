#!/bin/sh
# run.sh MACHINE IMAGE [OPTION...]: runs a firmware image, with further options for QEMU. Its output and exit code become this script's.
if ! command -v qemu-system-arm >/dev/null; then
  echo "skipped: qemu-system-arm is not installed"
  exit 1
fi
machine=$1 image=$2
shift 2
exec timeout 120 qemu-system-arm -M "$machine" -display none -monitor none -serial null \
  -chardev stdio,id=console,signal=off \
  -semihosting-config enable=on,target=native,chardev=console -kernel "$image" "$@" </dev/null
