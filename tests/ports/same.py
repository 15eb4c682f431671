#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""same.py NATIVE OTHER...: runs commands with the program of this host and with that of another system, and
compares all files and reports, byte for byte. OTHER is a command, such as `wine microtin.exe`."""
import pathlib
import random
import subprocess
import sys
import tempfile

COMMANDS = """
fractal --size 129 -o hills.asc
fractal --size 257 --seed 3 -o wide.asc
encode hills.asc --max-error 5 -o hills.mtin
encode hills.asc --max-error 5 --coding quick -o quick.mtin
encode hills.asc --max-error 5 --coding dense -o dense.mtin
encode hills.asc --max-error 5 --fast -o fast.mtin
encode hills.asc --max-vertices 300 --best -o best.mtin
encode hills.asc --max-bytes 900 --phases -o most.mtin
encode hills.asc --max-error 0 -o exact.mtin
encode hills.asc --max-error 8 --never-below --digest -o above.mtin
encode towns.xyz --max-error 0.5 --units metre -o towns.mtin
encode towns.xyz --max-error 0.5 --units metre --tile-vertices 200 -o towns.mtp
encode - --max-error 0.5 --units metre -o piped.mtin <towns.xyz
encode hills.asc --max-error 5 -o - >output.mtin
encode wide.asc --max-error 4 --tile-vertices 300 -o wide.mtp
encode wide.asc --max-error 4 --tile-vertices 300 --shard 0:2 --resume tiles.log -o first.shard
encode wide.asc --max-error 4 --device-ram 60000 -o small.mtp
verify hills.mtin hills.asc --json
verify wide.mtp wide.asc
update wide.mtp wide.asc -o new.mtp
decode hills.mtin -o hills.obj
decode hills.mtin -o hills.ply
decode hills.mtin -o hills.glb
decode hills.mtin -o grid.asc --cell 2
decode wide.mtp -o wide.obj
render hills.mtin -o hills.png
render hills.mtin -o hills.svg --title Hills --contours auto
render wide.mtp -o wide.png --no-mesh
render towns.mtin -o towns.html
embed hills.mtin -o hills.h
embed wide.mtp -o wide.h
info hills.mtin --json
info wide.mtp
height hills.mtin 5.25 7.5
height wide.mtp 200 17
profile hills.mtin 3 5 120 110 --json
profile hills.mtin 3 5 120 110 -o profile.svg
cut wide.mtp --extent 10,10,90,90 -o cut.mtp
"""

REFUSED = """
encode missing.asc --max-error 3 -o nothing.mtin
encode hills.asc --max-error 3 -o hills.asc
encode hills.asc --max-error 3 -o absent/hills.mtin
verify hills.mtin wide.asc
info hills.asc
"""


def write_towns(folder):
    random.seed(11)
    lines = [f"{random.uniform(0, 900):.2f} {random.uniform(0, 900):.2f} {random.gauss(50, 9):.3f}\r\n"
             for _ in range(1500)]
    (folder / "towns.xyz").write_bytes("".join(lines).encode())


def run(program, folder, command):
    """What one command returns and prints. Redirections carry bytes, as those of a shell do."""
    words = command.split()
    given = printed = None
    if words[-1].startswith("<"):
        given = open(folder / words.pop()[1:], "rb")
    if words[-1].startswith(">"):
        printed = open(folder / words.pop()[1:], "wb")
    result = subprocess.run([*program, *words], cwd=folder, stdin=given, stdout=printed or subprocess.PIPE,
                            stderr=subprocess.PIPE, timeout=1200)
    for file in filter(None, (given, printed)):
        file.close()
    return result.returncode, result.stdout, result.stderr


def fail(*texts):
    print("different:", *texts)
    sys.exit(1)


def compare_commands(programs, folders, commands, succeed):
    for command in commands.strip().splitlines():
        results = [run(program, folder, command) for program, folder in zip(programs, folders)]
        if results[0] != results[1] or (results[0][0] == 0) != succeed:
            fail(command, *results)


def compare(programs, root):
    folders = [root / "été-一" / name for name in ("native", "other")]
    for folder in folders:
        folder.mkdir(parents=True)
        write_towns(folder)
    compare_commands(programs, folders, COMMANDS, True)
    compare_commands(programs, folders, REFUSED, False)
    names = [sorted(path.name for path in folder.iterdir()) for folder in folders]
    if names[0] != names[1]:
        fail(*names)
    for name in names[0]:
        if (folders[0] / name).read_bytes() != (folders[1] / name).read_bytes():
            fail(name)
    return len(names[0])


def main():
    words = [str(pathlib.Path(word).resolve()) if pathlib.Path(word).exists() else word for word in sys.argv[1:]]
    programs = [words[:1], words[1:]]
    with tempfile.TemporaryDirectory() as root:
        files = compare(programs, pathlib.Path(root))
    count = len((COMMANDS + REFUSED).split("\n")) - 3
    print(f"{count} commands with the same reports and the same {files} files")


if __name__ == "__main__":
    main()
