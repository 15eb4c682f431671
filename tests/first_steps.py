#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""first_steps.py [PROGRAM]: runs the first steps of decoder/docs/quickstart.md, at most ten commands, and fails unless device and
host tell the same height. With a PROGRAM that is built already, nothing is installed and the program is not built."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 10

guide = (ROOT / "decoder/docs/quickstart.md").read_text()
commands = re.search(r"^## First steps\n.*?^```sh\n(.*?)^```", guide, re.M | re.S)[1].splitlines()
if len(commands) > MOST:
    sys.exit(f"rejected: the first steps are {len(commands)} commands")
if len(sys.argv) > 1:
    for tool in ("arm-none-eabi-g++", "qemu-system-arm"):
        if shutil.which(tool) is None:
            print(f"skipped: {tool} is not installed")
            sys.exit(77)
    commands = [c for c in commands if not re.match(r"\.ci/install|cmake --workflow", c)]
    commands = [c.replace("build/tool/microtin", sys.argv[1]) for c in commands]

last = []
for command in commands:
    print("$", command)
    run = subprocess.run(command, shell=True, cwd=ROOT, capture_output=True, text=True)
    print(run.stdout + run.stderr)
    if run.returncode != 0:
        sys.exit(f"rejected: exit code {run.returncode}")
    last = [*last, run.stdout][-2:]
device, host = (float(re.search(r"(-?[\d.]+)( mm)?\s*$", said)[1]) for said in last)
if device != round(host * 1000):
    sys.exit(f"rejected: the device says {device} mm, the host {host} m")
print(f"{len(commands)} commands, one height")
