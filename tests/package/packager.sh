#!/bin/sh
# SPDX-License-Identifier: MIT
# packager.sh SOURCES FOLDER: configures the sources as the packages of a distribution are, without building them.
set -eu
sources=$1 folder=$2
rm -rf "$folder"
command -v gdal-config >/dev/null && gdal=ON || gdal=OFF

cmake -S "$sources" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DMICROTIN_TESTS=OFF -DMICROTIN_VIEWER=OFF \
  -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_INSTALL_INCLUDEDIR=include/of-microtin -DMICROTIN_STATIC_ZLIB=OFF \
  -DMICROTIN_GDAL_DRIVER=$gdal -DMICROTIN_QGIS_DRIVER=ON

expect() { # PATTERN FILE...
  grep -qrE -e "$@" || { echo "rejected: $1 is not in" "$@"; exit 1; }
}

reject() { # PATTERN FILE...
  if grep -rE -e "$@"; then echo "rejected: $1"; exit 1; fi
}

expect 'includedir=[$][{]prefix[}]/include/of-microtin$' "$folder/decoder/microtin.pc"
expect '^Libs: .* -lmicrotin$' "$folder/encoder/libmicrotin.pc"
exports=$(find "$folder" -path '*/Export/*' -name 'microtin*.cmake')
[ "$(grep -l '_IMPORT_PREFIX}/include/of-microtin"' $exports | wc -l)" = 3 ] || { echo "rejected: other headers"; exit 1; }
expect 'microtin::microtin' $exports
reject '/include"' $exports
reject 'libz\.a' "$folder/build.ninja"
reject '-Werror' "$folder/build.ninja"
# Each installed file belongs to a component.
for component in tool library development licences qgis; do
  expect "CMAKE_INSTALL_COMPONENT STREQUAL \"$component\"" --include=cmake_install.cmake "$folder"
done
reject 'CMAKE_INSTALL_COMPONENT STREQUAL "Unspecified"' --include=cmake_install.cmake "$folder"
expect 'lib[^"]*/mdalplugins' "$folder/encoder/qgis/cmake_install.cmake"
[ $gdal = OFF ] || expect 'lib[^"]*/gdalplugins' "$folder/encoder/gdal/cmake_install.cmake"

# The users' preset has no warnings for errors, those of developers have.
cmake -S "$sources" --preset tool -B "$folder/tool" -DMICROTIN_VIEWER=OFF
reject '-Werror' "$folder/tool/build.ninja"
echo "as a package"
