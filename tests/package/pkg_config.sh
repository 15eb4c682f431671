#!/bin/sh
# SPDX-License-Identifier: MIT
# pkg_config.sh COMPILER PREFIX VERSION SOURCE FLAGS...: builds and runs a C program by what pkg-config says of the
# library installed in PREFIX, whose version must be the given one.
set -eu
compiler=$1 prefix=$2 version=$3 source=$4
shift 4
command -v pkg-config >/dev/null || { echo "skipped: pkg-config is not installed"; exit 77; }
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name microtin.pc)")
export PKG_CONFIG_PATH
test "$(pkg-config --modversion microtin)" = "$version"
# shellcheck disable=SC2046
"$compiler" "$@" "$source" -x none $(pkg-config --cflags --libs microtin) -o "$prefix/consumer"
"$prefix/consumer"
