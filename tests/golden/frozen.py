#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""frozen.py [--write VERSION | --planted]: no file in the folder of a released version has changed, is gone or was added.

VERSION.sha256 lists the files of the folder VERSION with their hashes, as sha256sum does. The hash of this list stands
below, so that neither a file nor the list changes unnoticed. --write makes the list of a version that is not below yet.
--planted changes, removes, renames and adds a file of a copy, and changes the list: each must be found."""

import hashlib
import shutil
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
REMEDY = "files of a released version never change; restore it, and put new files into the folder of the next version"
# The SHA-256 of each version's list.
FROZEN = {
    "1.0": "573b7119615c147e2577a6c2b9129220e5f5aeea2594ed9c407f80d64c0c1457",
}


def sums_of(folder):
    """Each file of the folder, by its path in it, and its hash."""
    files = sorted(path for path in folder.rglob("*") if not path.is_dir())
    return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def list_of(sums):
    return "".join(f"{digest}  {name}\n" for name, digest in sorted(sums.items()))


def faults(folder, frozen):
    """What is wrong with the folders of versions in `folder`: place, fault and remedy."""
    versions = {path.name for path in folder.iterdir() if path.is_dir() and path.name[0].isdigit()}
    for version in sorted(versions - set(frozen)):
        yield f"{version}: the hash of its list is not in frozen.py; write {version}.sha256 (--write) and add its hash"
    for version, expected in frozen.items():
        path = folder / f"{version}.sha256"
        text = path.read_text() if path.exists() else ""
        if hashlib.sha256(text.encode()).hexdigest() != expected:
            yield f"{path.name}: is not the list that frozen.py has the hash of; {REMEDY}"
        recorded = {name: digest for digest, name in (line.split("  ", 1) for line in text.splitlines())}
        found = sums_of(folder / version)
        for name in sorted(recorded.keys() | found.keys()):
            if recorded.get(name) != found.get(name):
                what = "is gone" if name not in found else "was added" if name not in recorded else "has changed"
                yield f"{version}/{name}: {what}; {REMEDY}"


def planted():
    """Whether each planted fault is found, and nothing else."""

    def change(name):
        def plant(folder):
            data = bytearray((folder / name).read_bytes())
            data[-1] ^= 1
            (folder / name).write_bytes(data)

        return plant

    def rename(folder):
        (folder / "1.0/pair.mtp").rename(folder / "1.0/two.mtp")

    cases = {
        "1.0/hills.mtin: has changed": change("1.0/hills.mtin"),
        "1.0/hills.report: has changed": change("1.0/hills.report"),
        "1.0/voids.mtin: is gone": lambda folder: (folder / "1.0/voids.mtin").unlink(),
        "1.0/refused/new.mtin: was added": lambda folder: (folder / "1.0/refused/new.mtin").write_bytes(b""),
        "1.0/pair.mtp: is gone|1.0/two.mtp: was added": rename,
        "1.0.sha256: is not": lambda folder: (folder / "1.0.sha256").write_text(list_of(sums_of(folder / "1.0"))[:-1]),
        "1.1: the hash": lambda folder: (folder / "1.1").mkdir(),
    }
    missed = 0
    for expected, plant in cases.items():
        with tempfile.TemporaryDirectory() as name:
            copy = Path(name) / "golden"
            shutil.copytree(FOLDER, copy)
            plant(copy)
            found = list(faults(copy, FROZEN))
        starts = expected.split("|")
        if len(found) != len(starts) or not all(map(str.startswith, found, starts)):
            missed += 1
            print(f"rejected: for the planted fault {expected!r} found {found}")
    print(f"{len(cases)} planted faults, {missed} missed")
    return missed


def main():
    if sys.argv[1:2] == ["--write"]:
        version = sys.argv[2]
        if version in FROZEN:
            sys.exit(f"rejected: {version} is frozen")
        text = list_of(sums_of(FOLDER / version))
        (FOLDER / f"{version}.sha256").write_text(text)
        print(f'    "{version}": "{hashlib.sha256(text.encode()).hexdigest()}",')
        return 0
    if sys.argv[1:] == ["--planted"]:
        return 1 if planted() else 0
    found = list(faults(FOLDER, FROZEN))
    for fault in found:
        print(f"rejected: tests/golden/{fault}")
    count = sum(len(sums_of(FOLDER / version)) for version in FROZEN)
    print(f"{count} frozen files of {len(FROZEN)} version{'s' if len(FROZEN) != 1 else ''}, {len(found)} rejected")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
