#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""windows.py PROGRAM: what only Windows does to names, devices and a console, with wine. PROGRAM is microtin.exe."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = ["wine", str(pathlib.Path(sys.argv[1]).resolve())]


def run(folder, *words, **more):
    return subprocess.run([*PROGRAM, *words], cwd=folder, capture_output=True, timeout=300, **more)


def expect(is_true, *texts):
    if not is_true:
        print("wrong:", *texts)
        sys.exit(1)


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


def test_names(folder):
    """Names, arguments and messages are Unicode, in folders too."""
    inside = folder / "ñandú 山"
    inside.mkdir()
    run(folder, "fractal", "--size", "33", "-o", "ñandú 山/ß.asc")
    made = run(folder, "encode", "ñandú 山", "--max-error", "5", "--source-name", "Çeşme", "-o", "€.mtin")
    expect(made.returncode == 0 and names_in(folder) == ["ñandú 山", "€.mtin"], made, names_in(folder))
    expect("Çeşme".encode() in run(folder, "info", "€.mtin").stdout, "the note of a source")
    expect("фу.mtin".encode() in run(folder, "info", "фу.mtin").stderr, "the name in a message")


def test_devices(folder):
    """NUL takes an output, and no file of that name appears."""
    run(folder, "fractal", "--size", "33", "-o", "a.asc")
    for name in ("NUL", "nul"):
        made = run(folder, "encode", "a.asc", "--max-error", "5", "-o", name)
        expect(made.returncode == 0 and names_in(folder) == ["a.asc"], made, names_in(folder))


def test_inputs(folder):
    """An input is recognised by another name: of other case, of another path, and of a link."""
    run(folder, "fractal", "--size", "33", "-o", "a.asc")
    os.link(folder / "a.asc", folder / "b.asc")
    before = (folder / "a.asc").read_bytes()
    for name in ("A.ASC", ".\\a.asc", "b.asc"):
        made = run(folder, "decode", "a.asc", "-o", name)
        expect(made.returncode == 1 and b"is also an input" in made.stderr, name, made)
    expect((folder / "a.asc").read_bytes() == before, "the input")


def test_replacement(folder):
    """An older output is replaced by a whole one, and kept if a command fails."""
    run(folder, "fractal", "--size", "33", "-o", "a.asc")
    (folder / "a.mtin").write_bytes(b"old")
    failed = run(folder, "encode", "a.asc", "--max-error", "-1", "-o", "a.mtin")
    expect(failed.returncode != 0 and (folder / "a.mtin").read_bytes() == b"old", failed)
    made = run(folder, "encode", "a.asc", "--max-error", "5", "-o", "a.mtin")
    expect(made.returncode == 0 and (folder / "a.mtin").read_bytes()[:4] == b"mtin", made)
    os.chmod(folder / "a.mtin", 0o444)  # which Windows calls read-only
    made = run(folder, "encode", "a.asc", "--max-error", "7", "-o", "a.mtin")
    expect(names_in(folder) == ["a.asc", "a.mtin"], made, names_in(folder))


def test_streams(folder):
    """Standard streams carry bytes: no end of line is converted, and no byte ends the input."""
    run(folder, "fractal", "--size", "129", "-o", "a.asc")
    run(folder, "encode", "a.asc", "--max-error", "3", "-o", "a.mtin")
    printed = run(folder, "encode", "a.asc", "--max-error", "3", "-o", "-").stdout
    expect(printed == (folder / "a.mtin").read_bytes() and b"\n" in printed, "standard output")
    points = b"".join(b"%d %d %d\n" % (x, y, x * y) for x in range(9) for y in range(9)) + b"#\x1a\n9 9 81\n"
    made = run(folder, "encode", "-", "--max-error", "1", "--units", "metre", "-o", "b.mtin", input=points)
    expect(b"source: 82 points" in made.stdout, made)
    closed = subprocess.Popen([*PROGRAM, "encode", "a.asc", "--max-error", "3", "-o", "-"], cwd=folder,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    closed.stdout.close()
    expect(closed.wait(300) in (1, 4), "a pipe that nobody reads", closed.stderr.read())


def test_console(folder):
    """Ctrl-C ends the program, and the part of an output that was written disappears."""
    run(folder, "fractal", "--size", "1025", "-o", "a.asc")
    process = subprocess.Popen([*PROGRAM, "encode", "a.asc", "--max-error", "2", "-o", "a.mtin"], cwd=folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(600):
        if len(names_in(folder)) == 2:
            break
        time.sleep(0.05)
    expect(len(names_in(folder)) == 2, "the part of an output", names_in(folder))
    process.send_signal(signal.SIGINT)
    code = process.wait(60)
    expect(code not in (0, 1) and names_in(folder) == ["a.asc"], code, names_in(folder))


def main():
    tests = [test_names, test_devices, test_inputs, test_replacement, test_streams, test_console]
    for test in tests:
        with tempfile.TemporaryDirectory() as root:
            test(pathlib.Path(root))
            print(test.__doc__)


if __name__ == "__main__":
    main()
