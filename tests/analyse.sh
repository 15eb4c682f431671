#!/bin/sh
# Static analysis of the decoder beside clang-tidy: gcc -fanalyzer, and cppcheck with tests/cppcheck.
set -eu
cd "$(dirname "$0")/.."
for bits in 16 32; do
  for source in decoder/*.cpp; do
    g++ -std=c++14 -O1 -I. -Idecoder/include -DMICROTIN_INDEX_BITS=$bits -fanalyzer -Werror -c "$source" -o /dev/null
  done
done
if ! command -v cppcheck >/dev/null; then
  echo "skipped: cppcheck is not installed"
  exit 77
fi
cppcheck -j "$(nproc)" --quiet --std=c++14 --enable=warning,portability --error-exitcode=1 \
  --suppressions-list=tests/cppcheck -DMICROTIN_INDEX_BITS=32 -I. -Idecoder/include decoder
cppcheck -j "$(nproc)" --quiet --std=c++17 --enable=warning,portability --error-exitcode=1 \
  --suppressions-list=tests/cppcheck -DMICROTIN_INDEX_BITS=32 -I. -Idecoder/include encoder
