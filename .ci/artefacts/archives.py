# SPDX-License-Identifier: MIT
"""archives.py ARCHIVE FOLDER: packs the files of FOLDER as ARCHIVE (.tar.gz, .zip or .pack), which depends on nothing but
their names and bytes, whether they can be run, and SOURCE_DATE_EPOCH."""

import gzip
import io
import os
import sys
import tarfile
import time
import zipfile
from pathlib import Path


def members(folder):
    """Name, bytes and mode of each file, in the order of the names' bytes. Links to files are packed as files."""
    paths = [path for path in folder.rglob("*") if path.is_file()]
    for name, path in sorted((path.relative_to(folder).as_posix(), path) for path in paths):
        yield name, path.read_bytes(), 0o755 if path.stat().st_mode & 0o100 else 0o644


def tar(archive, folder, epoch):
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as to:
        for name, content, mode in members(folder):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode, entry.mtime = len(content), mode, epoch
            to.addfile(entry, io.BytesIO(content))
    archive.write_bytes(gzip.compress(packed.getvalue(), 9, mtime=0))


def zip_(archive, folder, epoch):
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as to:
        for name, content, mode in members(folder):
            entry = zipfile.ZipInfo(name, time.gmtime(epoch)[:6])
            entry.compress_type, entry.create_system, entry.external_attr = zipfile.ZIP_DEFLATED, 3, mode << 16
            to.writestr(entry, content)


def main():
    archive, folder = Path(sys.argv[1]), Path(sys.argv[2])
    pack = tar if archive.name.endswith(".tar.gz") else zip_
    pack(archive, folder, int(os.environ["SOURCE_DATE_EPOCH"]))


if __name__ == "__main__":
    main()
