# SPDX-License-Identifier: MIT
"""outputs.py MICROTIN [FOLDER]: the documents, or those of a folder, state what their commands print. A block of commands that
begins with `microtin fractal` needs no other file: it runs in a new folder. If a block of lines `key: value` follows, and
the text between them ends with a colon, the commands must print each of the lines."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from conventions import ROOT, documents  # noqa: E402

BLOCK = re.compile(r"^```\w*\n(?P<fenced>.*?)^```$|^(?P<indented>(?:    [^\n]*\n)+)", re.M | re.S)


def pairs(text):
    """The lines of each such block of commands, and those of the block that states what they print, with its number."""
    blocks = list(BLOCK.finditer(text))
    for first, second in zip(blocks, blocks[1:]):
        commands, stated = (block["fenced"] or block["indented"] for block in (first, second))
        lines = [line.strip() for line in stated.splitlines()]
        is_output = text[first.end():second.start()].rstrip().endswith(":") and all(re.match(r"\w+: ", x) for x in lines)
        if is_output and commands.lstrip().startswith("microtin fractal "):
            yield commands, lines, text.count("\n", 0, second.start()) + 1


def printed(program, commands):
    with tempfile.TemporaryDirectory() as folder:
        script = re.sub(r"^\s*microtin ", lambda _: f"'{program}' ", commands, flags=re.M)
        run = subprocess.run(["sh", "-e"], input=script, cwd=folder, capture_output=True, text=True)
    return run.stdout.splitlines() + run.stderr.splitlines()


def main():
    program, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT
    checked = rejected = 0
    for document in documents(folder):
        for commands, lines, number in pairs(document.read_text()):
            checked += 1
            output = printed(program, commands)
            for line in lines:
                if line not in output:
                    rejected += 1
                    print(f"rejected: {document.relative_to(folder)}:{number}: the commands do not print '{line}'")
    print(f"{checked} outputs, {rejected} rejected")
    sys.exit(1 if rejected or not checked else 0)


main()
