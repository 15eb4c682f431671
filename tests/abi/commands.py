#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""commands.py [--write | --record FILE] PROGRAM: compares what scripts rely on with the record, commands.txt or FILE: the
commands, options and values of PROGRAM, its exit codes, and the keys of its reports in JSON with the kinds of their values.
What is new is allowed. --write records."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
RECORD = HERE / "commands.txt"
GOLDEN = HERE.parent / "golden/1.0"
# Reports, of files that have as many keys as possible. Files without a folder are made first.
MADE = (
    "fractal --size 33 -o t.asc",
    "encode t.asc --units metre --max-error 5 --never-below --digest --phases --license MIT -o t.mtin",
    "fractal --size 33 --seed 2 -o u.asc",
    "encode t.asc --units metre --max-error 5 --tile-size 16 --z-step 1 -o t.mtp",
    "encode u.asc --units metre --max-error 5 --tile-size 16 --z-step 1 -o u.mtp",
)
REPORTS = (
    *(f"info {GOLDEN}/{name}" for name in ("notes.mtin", "noted.mtp", "card.mtp", "voids.mtin")),
    "info t.mtin",
    "info t.mtp",
    f"check {GOLDEN}/unknown.mtp",
    "check t.mtin",
    "check damaged.mtp",
    "verify t.mtin t.asc",
    "verify t.mtp t.asc",
    "profile t.mtin 30 30 700 900 --from-height 2 --to-height 3 --frequency 868",
    "profile t.mtp 30 30 9000 900",
    "diff t.mtp u.mtp",
)
KINDS = {bool: "flag", int: "number", float: "number", str: "text", type(None): "null", list: "list", dict: "object"}


def options_of(program):
    """A line for each command, option and value of a choice."""
    page = subprocess.run([program, "reference"], capture_output=True, text=True, check=True).stdout
    command = ""
    for line in page.splitlines():
        if line.startswith("## "):
            command = line[3:]
            yield f"command {command}"
        row = re.match(r"\| `((?:-\w, )?--[^`]*)` \|", line)
        if row is None:
            continue
        names, _, value = row[1].replace("\\|", "|").rpartition(" ") if " " in row[1].split(", ")[-1] else (row[1], "", "")
        for name in names.split(", "):
            yield f"option {command} {name}" + (" VALUE" if value else "")
            if re.fullmatch(r"[a-z0-9-]+(\|[a-z0-9-]+)+", value):
                yield from (f"value {command} {name} {one}" for one in value.split("|"))


def keys_of(command, value, at=""):
    yield f"key {command} {at or '.'} {KINDS[type(value)]}"
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from keys_of(command, inner, f"{at}.{key}")
    for inner in value if isinstance(value, list) else ():
        yield from keys_of(command, inner, at + "[]")


def reports_of(program):
    with tempfile.TemporaryDirectory() as folder:
        for words in MADE:
            subprocess.run([program, *words.split()], cwd=folder, check=True, capture_output=True)
        pack = bytearray(Path(folder, "t.mtp").read_bytes())
        pack[-30] ^= 1  # of the last tile
        Path(folder, "damaged.mtp").write_bytes(pack)
        for words in REPORTS:
            run = subprocess.run([program, *words.split(), "--json"], cwd=folder, capture_output=True, text=True)
            command = words.split()[0]
            if not run.stdout:
                sys.exit(f"rejected: {words}: {run.stderr}")
            yield f"code {command} {run.returncode}"
            yield from keys_of(command, json.loads(run.stdout))


def main():
    program = str(Path(sys.argv[-1]).resolve())
    found = sorted({*options_of(program), *reports_of(program)})
    if "--write" in sys.argv:
        RECORD.write_text("".join(line + "\n" for line in found))
        print(f"written: tests/abi/commands.txt, {len(found)} lines")
        return
    record = Path(sys.argv[2]) if "--record" in sys.argv else RECORD
    recorded = record.read_text().splitlines()
    missing = sorted(set(recorded) - set(found))
    for line in missing:
        print("rejected: is no longer there:", line)
    print(f"{len(recorded)} names and kinds, {len(missing)} rejected")
    sys.exit(1 if missing else 0)


main()
