#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""first_steps.py device|map|page [PROGRAM]: runs the first steps of a guide, at most ten commands, as a newcomer does. Fails
unless the last two commands print one height, or the page shows it. With a PROGRAM that is built already, nothing is
installed and the program is not built."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 10
MARK = "== end of a command"
GUIDES = {
    "device": ("decoder/docs/quickstart.md", ("arm-none-eabi-g++", "qemu-system-arm")),
    "map": ("encoder/docs/gdal-qgis.md", ("gdaldem", "gdallocationinfo")),
    "page": ("encoder/docs/browser.md", ()),
}


def commands_of(guide, program):
    text = (ROOT / guide).read_text()
    commands = re.search(r"^## First steps\n.*?^```sh\n(.*?)^```", text, re.M | re.S)[1].splitlines()
    if len(commands) > MOST:
        sys.exit(f"rejected: the first steps of {guide} are {len(commands)} commands")
    if program is None:
        return commands
    commands = [c for c in commands if not re.match(r"\.ci/install|cmake --(workflow|preset tool|build --preset tool)", c)]
    return [c.replace("build/tool/microtin", program) for c in commands]


def outputs_of(commands):
    """What each command prints; all run in one shell, which ends with the first one that fails."""
    script = "\n".join(f"{command}\necho '{MARK}'" for command in commands)
    run = subprocess.run(["sh", "-e"], input=script, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    outputs = run.stdout.split(MARK + "\n")
    for command, output in zip(commands, outputs):
        print(f"$ {command}\n{output}", end="")
    if run.returncode != 0:
        sys.exit(f"rejected: exit code {run.returncode}")
    return outputs[: len(commands)]


def expect_one_height(outputs):
    found = [re.search(r"(-?[\d.]+)( mm)?\s*$", output) for output in outputs[-2:]]
    here, there = (float(one[1]) / (1000 if one[2] else 1) for one in found)
    if abs(here - there) > 0.0005:
        sys.exit(f"rejected: {here} m and {there} m")


def main():
    name, program = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    guide, tools = GUIDES[name]
    missing = [tool for tool in tools if program is not None and shutil.which(tool) is None]
    if missing:
        print(f"skipped: {missing[0]} is not installed")
        sys.exit(77)
    commands = commands_of(guide, program)
    outputs = outputs_of(commands)
    if name == "page":
        page = ROOT / commands[-1].split()[-1]
        if "<canvas" not in page.read_text():
            sys.exit(f"rejected: {page} has nothing to draw on")
        print(f"{len(commands)} commands, one page")
    else:
        expect_one_height(outputs)
        print(f"{len(commands)} commands, one height")


main()
