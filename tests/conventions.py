"""conventions.py CHECK [FOLDER]: what people expect of a repository holds in this one, or in a folder.

length  the README has at most 200 lines
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST_LINES = 200


def length(folder):
    lines = len((folder / "README.md").read_text().splitlines())
    return [f"README.md has {lines} lines, more than {MOST_LINES}"] if lines > MOST_LINES else []


CHECKS = {"length": length}
folder = Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT
faults = CHECKS[sys.argv[1]](folder)
for fault in faults:
    print("rejected:", fault)
sys.exit(1 if faults else 0)
