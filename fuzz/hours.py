# SPDX-License-Identifier: MIT
"""hours.py [--record | --sources]: prints how often and how long each fuzz target ran, as fuzz/log.txt states. --record first
adds the runs of this build folder to the log. --sources prints only the digest of the decoder's sources as they are."""

import hashlib
import re
import sys
from pathlib import Path

LOG = "fuzz/log.txt"
RUNS = "build/fuzz/executions"  # rows of fuzz/run: date, sources, target, executions, seconds
SOURCES = ("decoder/*.cpp", "decoder/*.hpp", "decoder/include/microtin/*", "shared/*.hpp")
STAMP = re.compile(rb"define MICROTIN_VERSION_\w+ \d+")  # which a release changes, and no fuzzing sees


def sources(root=Path(".")):
    """A digest of all that fuzzing the decoder runs. Any change of these sources, also of a comment, is another digest."""
    digest = hashlib.sha256()
    for path in sorted(path for pattern in SOURCES for path in root.glob(pattern)):
        digest.update(path.name.encode() + b"\n" + STAMP.sub(b"", path.read_bytes()))
    return digest.hexdigest()[:12]


def rows(path):
    """(date, sources, target), executions and seconds of each row; no rows without a file."""
    if not path.exists():
        return
    for line in path.read_text().splitlines():
        if line and not line.startswith("#"):
            date, digest, target, executions, seconds = line.split()
            yield (date, digest, target), int(executions), float(seconds)


def added(table):
    """Rows of the same key as one, in the order of their first ones."""
    total = {}
    for key, executions, seconds in table:
        before = total.get(key, (0, 0.0))
        total[key] = (before[0] + executions, before[1] + seconds)
    return total


def hours(root=Path(".")):
    """Hours of processor time in the log: in all, and of the decoder's sources as they are now."""
    table = [(key[1], seconds / 3600) for key, _, seconds in rows(root / LOG)]
    now = sources(root)
    return sum(spent for _, spent in table), sum(spent for digest, spent in table if digest == now)


def record():
    log = Path(LOG)
    comments = [line for line in log.read_text().splitlines() if line.startswith("#")]
    table = added([*rows(log), *rows(Path(RUNS))])
    lines = [f"{' '.join(key)} {executions} {seconds:.0f}" for key, (executions, seconds) in table.items()]
    log.write_text("\n".join([*comments, *lines]) + "\n")
    Path(RUNS).unlink(missing_ok=True)


def main():
    if "--sources" in sys.argv:
        print(sources())
        return
    if "--record" in sys.argv:
        record()
    for target, (executions, seconds) in added((key[2], n, spent) for key, n, spent in rows(Path(LOG))).items():
        print(f"{target}: {executions} executions, {seconds / 3600:.2f} hours")
    in_all, now = hours()
    print(f"all: {in_all:.2f} hours of processor time, {now:.2f} of them with the decoder's sources as they are")


if __name__ == "__main__":
    main()
