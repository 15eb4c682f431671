#!/bin/sh
# SPDX-License-Identifier: MIT
# Fails if clang-format would change a source file.
cd "$(dirname "$0")/.." || exit 1
if ! command -v clang-format >/dev/null; then
  echo "skipped: clang-format is not installed"
  exit 77
fi
find . \( -path ./build -o -path ./encoder/viewer/generated \) -prune -o \( -name '*.[ch]pp' -o -name '*.[ch]' \) -print |
  xargs clang-format --dry-run -Werror
