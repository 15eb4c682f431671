#!/bin/sh
# SPDX-License-Identifier: MIT
# debian.sh ROOT: uses Debian's packages that are unpacked into the folder ROOT. The program makes, encodes, verifies and
# draws a terrain. Programs in C and C++ find the libraries by pkg-config and by CMake. Python runs the tests of the
# module. GDAL reads a stream and a pack by the plugin.
set -eu
root=$1
tests=$(cd "$(dirname "$0")/.." && pwd)
libraries=$(dirname "$(find "$root/usr/lib" -name libmicrotin.so)")
plugins=$libraries/gdalplugins
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LD_LIBRARY_PATH="$libraries" PKG_CONFIG_PATH="$libraries/pkgconfig"

program() {
  export PATH="$root/usr/bin:$PATH"
  microtin fractal --size 129 -o try.asc
  microtin encode try.asc --max-error 10 --fast -o try.mtin
  microtin encode try.asc --max-error 10 --fast -o try.mtp
  microtin verify try.mtin try.asc
  microtin render try.mtin -o try.html
  gzip -dc "$root"/usr/share/man/man1/microtin.1.gz | grep -q '^\.TH MICROTIN 1'
}

by_pkg_config() { # NAME: the library of that name
  # shellcheck disable=SC2046
  cc -std=c99 -Wall -Werror "$tests/package/consumer.c" $(pkg-config --cflags --libs "$1") -o "$1"
  "./$1"
}

by_cmake() { # FOLDER: the project in that folder
  cmake -S "$tests/package/$1" -B "$1" -DCMAKE_PREFIX_PATH="$root/usr" >"$1.log" || { cat "$1.log"; exit 1; }
  cmake --build "$1" >>"$1.log" || { cat "$1.log"; exit 1; }
  "$1/consumer"
  grep -q "^microtin_DIR:.*=$libraries/cmake/microtin$" "$1/CMakeCache.txt"
}

by_python() {
  env -u MICROTIN_LIBRARY MICROTIN_TOOL="$root/usr/bin/microtin" PYTHONDONTWRITEBYTECODE=1 \
    PYTHONPATH="$root/usr/lib/python3/dist-packages" /usr/bin/python3 "$tests/python/microtin_test.py"
}

by_gdal() {
  # Where GDAL itself looks is the folder of the package.
  grep -qF "${plugins#"$root"}" "$(/sbin/ldconfig -p | sed -n 's/.*libgdal\.so\.[0-9]* .* => //p' | head -n 1)"
  for file in try.mtin try.mtp; do
    GDAL_DRIVER_PATH="$plugins" gdalinfo "$file" | grep -q '^Driver: MTIN/'
  done
}

cd "$work"
program
by_pkg_config libmicrotin
by_pkg_config microtin
for way in find_package shared encoder; do by_cmake $way; done
by_python
if command -v gdalinfo >/dev/null; then by_gdal; else echo "skipped: gdalinfo is not installed"; fi
echo "the packages work: program, pkg-config, CMake, Python, GDAL"
