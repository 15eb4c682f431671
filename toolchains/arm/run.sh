#!/bin/sh
# run.sh MACHINE IMAGE: runs a firmware image. Its output and exit code become this script's.
if ! command -v qemu-system-arm >/dev/null; then
  echo "skipped: qemu-system-arm is not installed"
  exit 1
fi
exec timeout 120 qemu-system-arm -M "$1" -display none -monitor none -serial null \
  -chardev stdio,id=console,signal=off \
  -semihosting-config enable=on,target=native,chardev=console -kernel "$2" </dev/null
