#!/bin/sh
# SPDX-License-Identifier: MIT
# install.sh PYTHON FOLDER: packs the sources for Python offline into FOLDER, of these a wheel, with the library of the
# environment's MICROTIN_LIBRARY, and installs it; its tests pass there without that. Sources and wheel hold what they must.
# The package without a library works with the one that the loader finds.
set -eu
python=$1 folder=$2
sources=$(cd "$(dirname "$0")/../.." && pwd)
"$python" -c "import setuptools, wheel, numpy, pip" || { echo "skipped: no numpy, pip, setuptools or wheel"; exit 77; }
# A copy, in which nothing may be left among the sources.
rm -rf "$folder"
mkdir -p "$folder/tree"
tar -C "$sources" -c CMakeLists.txt LICENSE MANIFEST.in THIRD_PARTY_LICENSES pyproject.toml setup.py decoder encoder \
  shared toolchains | tar -C "$folder/tree" -x
cp -r "$folder/tree" "$folder/copy"
(cd "$folder/tree" && "$python" setup.py --quiet sdist --dist-dir "$folder")
rm -rf "$folder/tree/build"
diff -rq -x __pycache__ "$folder/copy" "$folder/tree"

mkdir "$folder/unpacked"
tar -C "$folder/unpacked" -xf "$folder"/microtin-*.tar.gz --strip-components=1
diff -rq -x __pycache__ -x '*.egg-info' -x PKG-INFO -x setup.cfg "$folder/copy" "$folder/unpacked"
cd "$folder"
"$python" -m pip wheel --quiet --no-index --no-build-isolation --no-deps --wheel-dir "$folder" "$folder/unpacked"
"$python" - microtin-*.whl <<END
import sys, zipfile
wheel = zipfile.ZipFile(sys.argv[1])
text = {name.rpartition("/")[2]: wheel.read(name).decode(errors="replace") for name in wheel.namelist()}
assert "Root-Is-Purelib: false" in text["WHEEL"], text["WHEEL"]
assert "Tag: py3-none-linux_" in text["WHEEL"], text["WHEEL"]
assert "MIT License" in text["LICENSE"] and "zlib" in text["THIRD_PARTY_LICENSES"]
END
"$python" -m pip install --quiet --no-index --no-deps --root-user-action ignore --target "$folder/site" microtin-*.whl
env -u MICROTIN_LIBRARY PYTHONPATH="$folder/site" "$python" "$sources/tests/python/microtin_test.py"

# As packages of distributions are: for any machine, with the library of another package.
MICROTIN_SYSTEM_LIBRARY=1 "$python" -m pip wheel --quiet --no-index --no-build-isolation --no-deps \
  --wheel-dir "$folder/any" "$folder/unpacked"
"$python" -m pip install --quiet --no-index --no-deps --root-user-action ignore --target "$folder/any/site" \
  "$folder"/any/microtin-*-py3-none-any.whl
[ -z "$(find "$folder/any/site" -name '*.so*')" ]
env -u MICROTIN_LIBRARY LD_LIBRARY_PATH="$(dirname "$MICROTIN_LIBRARY")" PYTHONPATH="$folder/any/site" \
  "$python" "$sources/tests/python/microtin_test.py" Streams Library
