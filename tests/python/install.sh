#!/bin/sh
# SPDX-License-Identifier: MIT
# install.sh PYTHON FOLDER: pip installs the package offline into FOLDER, with the library of the environment's
# MICROTIN_LIBRARY, and its tests pass there without that.
set -eu
python=$1 folder=$2
sources=$(cd "$(dirname "$0")/../.." && pwd)
"$python" -c "import setuptools, wheel, numpy, pip" || { echo "skipped: no numpy, pip, setuptools or wheel"; exit 77; }
# A copy, in which nothing may be left among the sources.
rm -rf "$folder"
mkdir -p "$folder/sources/encoder" "$folder/sources/decoder"
cp -r "$sources/encoder/python" "$folder/sources/encoder/"
cp -r "$sources/decoder/include" "$folder/sources/decoder/"
"$python" -m pip install --quiet --no-index --no-build-isolation --no-deps --root-user-action ignore \
  --target "$folder/site" "$folder/sources/encoder/python"
diff -rq -x __pycache__ "$sources/encoder/python" "$folder/sources/encoder/python"
env -u MICROTIN_LIBRARY PYTHONPATH="$folder/site" "$python" "$sources/tests/python/microtin_test.py"
