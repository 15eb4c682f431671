# SPDX-License-Identifier: MIT
"""machines.py RECIPE [MICROTIN]: the recipes of encoder/docs/machines.md, as they are printed there, make the bytes
of a single run, and a worker that is killed loses its own shard alone. RECIPE is slurm, parallel, dask, or memory.

Slurm's array is a loop. Machines of GNU parallel are this one, by a command in place of ssh. Dask takes the Python package
that PYTHONPATH finds, in place of the program MICROTIN. Exits with 77 if something is not installed.
"""

import array
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "encoder/docs/machines.md").read_text()
ENCODE = "encode cells/ --max-error 10 --tile-vertices 1000"
PATIENCE = 120  # seconds


def skip(what):
    print(f"skipped: {what} is not installed")
    sys.exit(77)


def section(name):
    return re.search(rf"^## {name}\n(.*?)(?=^## |\Z)", PAGE, re.M | re.S)[1]


def block(name, language):
    """The program that a section prints."""
    return re.search(rf"^```{language}\n(.*?)^```", section(name), re.M | re.S)[1]


def commands(name):
    """The lines of the shell that a section prints."""
    return "".join(line[4:] + "\n" for line in section(name).splitlines() if line.startswith("    "))


def write_cell(path, longitude, posts):
    """A cell of rough terrain, the same for each longitude."""
    seed = 1
    with open(path, "wb") as file:
        for row in range(posts):
            heights = array.array("h")
            for column in range(posts):
                seed = (seed * 1103515245 + 12345) % (1 << 31)
                x, y = (longitude * (posts - 1) + column) / 9, row / 11
                rough = 200 * math.sin(x) * math.cos(y) + 70 * math.sin(3.1 * x + y) + seed % 31
                heights.append(round(700 + (rough if 0 < column < posts - 1 else 0)))
            heights.byteswap()
            file.write(heights.tobytes())


def write_cells(cells=2, posts=121):
    os.makedirs("cells", exist_ok=True)
    for cell in range(cells):
        write_cell(f"cells/N50E{10 + cell:03}.hgt", cell, posts)


def prepare(microtin):
    """Makes `microtin` the first program of that name, and the pack of a single run."""
    os.makedirs("bin")
    os.symlink(microtin, "bin/microtin")
    os.environ["PATH"] = os.path.abspath("bin") + os.pathsep + os.environ["PATH"]
    subprocess.run(f"microtin {ENCODE} -o single.mtp", shell=True, check=True, stdout=subprocess.DEVNULL)


def shards(pattern="*.shard"):
    return {path.name: path.stat().st_mtime_ns for path in Path().glob(pattern)}


def expect(holds, what):
    if not holds:
        sys.exit("rejected: " + what)


def expect_single(name="area.mtp"):
    expect(Path(name).read_bytes() == Path("single.mtp").read_bytes(), f"{name} is not the pack of a single run")


def expect_kept(before, after, lost):
    """Every shard that was there is the same file, and the lost one is made."""
    expect(lost not in before and lost in after, f"{lost} was not made again")
    expect(all(after[name] == made for name, made in before.items()), "shards that were there are encoded again")


def kill_when(started, child):
    """Kills a process and its children as soon as a condition holds, unless it is done before."""
    end = time.monotonic() + PATIENCE
    while not started() and child.poll() is None:
        expect(time.monotonic() < end, "the worker does not start")
        time.sleep(0.001)
    if child.poll() is None:
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()


def try_again(attempt):
    """Attempts that a busy machine makes too late leave all as it was."""
    expect(any(attempt() for _ in range(20)), "nothing could be killed in time")


def begun(name):
    """Whether a file, or what will become it, is there."""
    return lambda: any(Path().glob(f"*{name}*"))


def slurm():
    plan, submit, merge = commands("Slurm").splitlines()
    subprocess.run(plan, shell=True, check=True)
    Path("pack.slurm").write_text(block("Slurm", "sh"))
    expect("pack.slurm" in submit, "the page submits another job")
    count = len(Path("shards").read_text().splitlines())
    expect(count > 4, "there are too few shards")

    def task(number, **more):
        environment = dict(os.environ, SLURM_ARRAY_TASK_ID=str(number))
        return subprocess.Popen(["sh", "pack.slurm"], env=environment, stdout=subprocess.DEVNULL, **more)

    def array_of_tasks(but=0):
        return [task(number).wait() for number in range(1, count + 1) if number != but]

    def kill_third():
        """Whether the task left no shard."""
        kill_when(begun("3.shard"), task(3, start_new_session=True))
        is_done = Path("3.shard").exists()
        Path("3.shard").unlink(missing_ok=True)
        return not is_done

    try_again(kill_third)
    expect(not any(array_of_tasks(but=3)), "a task failed")
    before = shards()
    expect(len(before) == count - 1, "a task made no shard")
    expect(not any(array_of_tasks()), "a task failed")
    expect_kept(before, shards(), "3.shard")
    expect(task(count + 1, stderr=subprocess.DEVNULL).wait() != 0, "a task beyond the last shard succeeds")
    subprocess.run(merge, shell=True, check=True, stdout=subprocess.DEVNULL)
    print(f"{count} tasks, one killed")


def parallel():
    if shutil.which("parallel") is None:
        skip("parallel")
    # Machines by the name of ssh: each runs the words of its command with a shell, as sshd does. GNU parallel runs no job
    # and reports success where SHELL is not set; sshd sets it.
    Path("bin/ssh").write_text(
        '#!/bin/sh\nwhile [ "${1#-}" != "$1" ]; do shift; done\nshift\n[ "$1" != -- ] || shift\n'
        'export SHELL=/bin/sh\nexec sh -c "$*"\n'
    )
    os.chmod("bin/ssh", 0o755)
    os.environ["PARALLEL_SSH"] = os.path.abspath("bin/ssh")
    Path("machines").write_text("1/alpha\n1/beta\n")
    # Each run of the program for the third shard is killed, until the file `kill` is gone.
    Path("bin/microtin").rename("bin/real")
    Path("bin/microtin").write_text(
        '#!/bin/sh\ncase "$*" in *" 3.shard") [ -e kill ] && echo >>killed && kill -9 $$ ;; esac\n'
        'exec "$(dirname "$0")/real" "$@"\n'
    )
    os.chmod("bin/microtin", 0o755)
    Path("encode.sh").write_text(commands("GNU parallel over ssh"))
    Path("kill").touch()
    run = subprocess.run(["sh", "-e", "encode.sh"], stdout=subprocess.DEVNULL)
    expect(run.returncode != 0 and Path("killed").read_text() == "\n" * 3, "the third job was not killed three times")
    before = shards()
    Path("kill").unlink()
    subprocess.run(["sh", "-e", "encode.sh"], check=True, stdout=subprocess.DEVNULL)
    expect_kept(before, shards(), "3.shard")
    print(f"{len(before) + 1} jobs on two machines, one killed")


class Cluster:
    """A scheduler and workers of Dask."""

    def __init__(self):
        self.processes = []
        self.start("scheduler", "--port", "0", "--no-dashboard")
        end = time.monotonic() + PATIENCE
        while not self.has_address():
            if time.monotonic() > end:
                self.stop()
                sys.exit("rejected: the scheduler does not start")
            time.sleep(0.05)

    def has_address(self):
        """The scheduler's file is there before its content is."""
        try:
            self.address = json.loads(Path("dask.json").read_text())["address"]
        except (FileNotFoundError, json.JSONDecodeError):
            return False
        return True

    def start(self, kind, *options):
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--scheduler-file", "dask.json", *options]
        log = open("dask.log", "ab")
        self.processes.append(subprocess.Popen(command, stdout=log, stderr=log, start_new_session=True))
        return self.processes[-1]

    def worker(self):
        return self.start("worker", "--nthreads", "1", "--no-dashboard", "--no-nanny")

    def stop(self):
        for process in self.processes:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def dask():
    try:
        import distributed  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as missing:
        skip(missing.name)
    import microtin

    microtin.encode_pack("cells", "single.mtp", 10, tile_vertices=1000)
    Path("pack.py").write_text(block("Dask", "python"))
    cluster = Cluster()
    try:
        run_dask(cluster)
    finally:
        cluster.stop()


def run_dask(cluster):
    driver = [sys.executable, "pack.py", cluster.address, os.path.abspath("cells"), os.path.abspath("area.mtp")]
    cluster.worker()

    def kill_one():
        """A worker dies while both encode; the other one takes its shard."""
        for path in [*Path().glob("*.shard"), *Path().glob("area.mtp")]:
            path.unlink()
        worker = cluster.worker()
        child = subprocess.Popen(driver, stdout=subprocess.DEVNULL, start_new_session=True)
        kill_when(lambda: len(shards()) > 1, worker)
        is_killed_in_time = child.poll() is None
        expect(child.wait(PATIENCE) == 0, "the driver failed: " + Path("dask.log").read_text()[-2000:])
        expect_single()
        return is_killed_in_time

    try_again(kill_one)
    # All is stopped, and run again.
    before = shards()
    lost = "area.mtp.2.shard"
    Path(lost).unlink()
    Path("area.mtp").unlink()
    before.pop(lost)
    subprocess.run(driver, check=True, stdout=subprocess.DEVNULL, timeout=PATIENCE)
    expect_kept(before, shards(), lost)
    print(f"{len(before) + 1} shards, one of two workers killed")


def peak_memory(command):
    """Bytes that a run takes at most."""
    child = subprocess.Popen(command, shell=True, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    expect(status == 0, "failed: " + command)
    return usage.ru_maxrss * 1024


def memory():
    """The same shard of few and of many cells, which have so many posts that allocators' pages count for little."""
    posts = 361
    write_cells(posts=posts)

    def shard():
        return peak_memory(f"exec microtin {ENCODE} --tile-size 30 --z-step 8 --shard 0:3 -o t.shard")

    few = shard()
    for cell in range(2, 34):
        os.link("cells/N50E010.hgt", f"cells/N50E{10 + cell:03}.hgt")
    many = shard()
    growth = (many - few) / (32 * posts * posts)
    print(f"{few / 1e6:.1f} MB for 2 cells, {many / 1e6:.1f} MB for 34: {growth:.2f} bytes a post")
    expect(growth < 0.5, "the memory of a worker grows with the area")


def main():
    recipe = sys.argv[1]
    programs = [os.path.abspath(path) for path in sys.argv[2:]]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            write_cells()
            for microtin in programs:
                prepare(microtin)
            {"slurm": slurm, "parallel": parallel, "dask": dask, "memory": memory}[recipe]()
            if recipe != "memory":
                expect_single()
        finally:
            os.chdir("/")


main()
