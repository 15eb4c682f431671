#!/bin/sh
# SPDX-License-Identifier: MIT
# static.sh OBJDUMP COMPILER FLAG... SOURCE: compiles a source at -O0, and rejects it if it has static constructors or
# initialised data.
set -eu
objdump=$1
shift
object=$(mktemp)
trap 'rm -f "$object"' EXIT
"$@" -O0 -c -o "$object"
found=$("$objdump" -h "$object" | grep -oE '^ *[0-9]+ \.(init_array|ctors|data)[^ ]* +0*[1-9a-f]' | awk '{ print $2 }')
if [ -n "$found" ]; then
  echo "rejected: $found"
  exit 1
fi
echo "nothing before main"
