#!/bin/sh
# SPDX-License-Identifier: MIT
# options.sh SOURCES FOLDER CASE: configures the page of render -o FILE.html, with or without its tools, and checks what
# the build says and takes.
set -eu
sources=$1 folder=$2/$3 case=$3
rm -rf "$folder"
mkdir -p "$folder/tree/viewer/generated" "$folder/tree/cli" "$folder/empty"
cp "$sources"/encoder/viewer/viewer.cmake "$sources"/encoder/viewer/absent.cpp.in "$folder/tree/viewer"
cp "$sources/encoder/cli/documents.cmake" "$folder/tree/cli"
cmake=$(command -v cmake) ninja=$(command -v ninja)

# Prints what CMake says, and its exit code; none of the page's tools is found.
without_tools() {
  PATH=$folder/empty "$cmake" -S "$sources/tests/viewer/project" -B "$folder/build" -G Ninja \
    -DCMAKE_MAKE_PROGRAM="$ninja" -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -DENCODER="$folder/tree" "$@" 2>&1 &&
    echo "exit code 0" || echo "exit code $?"
}

expect() { # TEXT PATTERN...
  text=$1
  shift
  for pattern; do
    if ! printf '%s' "$text" | tr '\n' ' ' | grep -qE "$pattern"; then
      printf '%s\nrejected: does not say "%s"\n' "$text" "$pattern"
      exit 1
    fi
  done
}

case $case in
  on) expect "$(without_tools -DMICROTIN_VIEWER=ON)" "exit code 1" "MICROTIN_VIEWER is ON, but .*esbuild" ;;
  auto)
    expect "$(without_tools)" "exit code 0" "Left out: the page .*esbuild.*\.ci/packages/tool"
    expect "$(cat "$folder/build/viewer_page.cpp")" "these programs were not found: clang\+\+, .*esbuild"
    ;;
  off)
    output=$(without_tools -DMICROTIN_VIEWER=OFF)
    expect "$output" "exit code 0"
    if printf '%s' "$output" | grep "the page of"; then exit 1; fi
    expect "$(cat "$folder/build/viewer_page.cpp")" "MICROTIN_VIEWER was OFF"
    ;;
  generated)
    touch "$folder/tree/viewer/generated/viewer_page.cpp"
    expect "$(without_tools -DMICROTIN_VIEWER=ON)" "exit code 0" "page: $folder/tree/viewer/generated/viewer_page.cpp"
    ;;
  cross) # a program that cannot run prints no manual page
    expect "$(without_tools)" "exit code 0" "Left out: manual page and completions"
    "$ninja" -C "$folder/build" microtin
    ;;
  flags) # flags for the host, and another generator than Ninja
    for tool in clang++ wasm-ld llvm-ar wasm-opt zopfli esbuild make; do
      command -v $tool >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
    done
    export CXXFLAGS="-march=native -fcf-protection" LDFLAGS="-Wl,-z,relro"
    cmake -S "$sources/tests/viewer/project" -B "$folder/build" -G "Unix Makefiles" -DENCODER="$sources/encoder" \
      -DMICROTIN_VIEWER=ON
    cmake --build "$folder/build"
    grep -q kPage "$folder/build/viewer_page.cpp"
    ;;
esac
echo "as expected: $case"
