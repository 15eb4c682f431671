# SPDX-License-Identifier: MIT
"""memory.py MICROTIN: what a stream takes to encode, at most so many bytes of memory a post.

All of the process counts, of which the program itself is 4 bytes a post of so small a raster.
"""
import array
import os
import subprocess
import sys
import tempfile

SIDE, MOST = 1201, 51


def peak_bytes(*command):
    """The most memory of a run, which includes that of this process when it began."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit("failed: %s" % (command,))
    return usage.ru_maxrss * 1024


microtin = os.path.abspath(sys.argv[1])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    subprocess.run([microtin, "fractal", "--size", str(SIDE), "-o", "area.asc"], check=True)
    with open("area.asc") as text, open("N10E010.hgt", "wb") as file:
        for line in text:
            if not line[0].isalpha():
                row = array.array("h", map(int, line.split()))
                row.byteswap()
                file.write(row.tobytes())
    most = peak_bytes(microtin, "encode", "N10E010.hgt", "--max-error", "20", "--fast", "-o", "area.mtin")
    os.chdir("/")
each = most / SIDE**2
print("%.1f bytes a post" % each)
if each > MOST:
    sys.exit("expected at most %d" % MOST)
