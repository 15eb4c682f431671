#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""macos.py FOLDER: what can be checked of a build for macOS, in FOLDER, without Apple's headers and libraries.

The whole project is configured for macOS with clang and lld (macos.cmake). The decoder is compiled for arm64. The
decoder's objects are then linked with the options of each program, library and plugin, so that lld takes all of them,
and a library shows only the names that it should. The encoder is not compiled: its headers are Apple's."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
CLANG = ["clang++", "--target=arm64-apple-macos11"]
KINDS = {"SHARED_LIBRARY": ["-dynamiclib"], "MODULE_LIBRARY": ["-bundle"],
         "EXECUTABLE": ["-Wl,-e,_microtin_read_stream_info"]}  # fmt: skip
EXPECTED = {"microtin_shared": "libmicrotin.{version}.dylib", "microtin": "microtin",
            "microtin_mdal": "mdalplugins/libmicrotin_mdal.so"}  # fmt: skip
GNU = "-Xlinker --exclude-libs -Xlinker ALL"


def run(*command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True)


def must_run(*command):
    done = run(*command)
    if done.returncode != 0:
        sys.exit(f"rejected: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def links_of(folder):
    """Each target that is linked: name, kind, file, options of the linker."""
    text = (folder / "build.ninja").read_text()
    kinds = "|".join(KINDS)
    for block in re.findall(rf"^build [^\n]*: CXX_(?:{kinds})_LINKER__.*?\n\n", text, re.M | re.S):
        file, kind, target = re.match(r"build (\S+).*?: CXX_([A-Z_]+)_LINKER__(\w+)_Release ", block).groups()
        flags = re.search(r"^  LINK_FLAGS = (.*)$", block, re.M)
        yield target, kind, file, flags.group(1) if flags else ""


def link(folder, kind, flags):
    """Links the decoder with these options. What the linker prints if it fails, else nothing."""
    whole = ["-nostdlib", "-Wl,-undefined,dynamic_lookup", "-Wl,-all_load", folder / "libmicrotin_decoder.a"]
    done = run(*CLANG, *KINDS[kind], "-fuse-ld=lld", *flags.split(), *whole, "-o", folder / "linked")
    return done.stderr if done.returncode != 0 else ""


def names_in(file):
    """The external names that a Mach-O file defines."""
    lines = must_run("llvm-nm", "--extern-only", "--defined-only", file).splitlines()
    return {line.split()[-1] for line in lines if len(line.split()) == 3 and "mh_" not in line}


def faults(folder, version):
    files = {}
    faces = {name for name in names_in(folder / "libmicrotin_decoder.a") if name.startswith("_microtin_")}
    for target, kind, file, flags in links_of(folder):
        files[target] = file
        refusal = link(folder, kind, flags)
        if refusal:
            yield f"{target}: the linker refuses its options: {refusal}"
        elif kind != "EXECUTABLE":
            shown = names_in(folder / "linked")
            expected = faces if target == "microtin_shared" else set()
            if shown != expected:
                yield f"{target}: shows {sorted(shown ^ expected)[:3]} too many or too few"
    for target, name in EXPECTED.items():
        if files.get(target) != name.format(version=version):
            yield f"{target}: makes {files.get(target)}, not {name.format(version=version)}"


def missed(folder):
    """Planted faults that the checks above would not find."""
    if "unknown argument" not in link(folder, "SHARED_LIBRARY", GNU):
        yield "an option of GNU's linker is not refused"
    if link(folder, "SHARED_LIBRARY", "") or not any(name.startswith("__Z") for name in names_in(folder / "linked")):
        yield "a library without a list of names shows no name of C++"


def main():
    folder = Path(sys.argv[1])
    clang = shutil.which("clang++")
    if not clang or not shutil.which("llvm-nm") or not (Path(clang).resolve().parent / "ld64.lld").exists():
        print("skipped: clang, llvm or lld is not installed")
        return 77
    shutil.rmtree(folder, ignore_errors=True)
    header = (ROOT / "decoder/include/microtin/microtin.h").read_text()
    version = ".".join(re.findall(r"define MICROTIN_VERSION_[A-Z]+ (\d+)", header))
    gdal = "ON" if shutil.which("gdal-config") else "OFF"
    must_run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "--toolchain", ROOT / "tests/ports/macos.cmake",
             "-DCMAKE_BUILD_TYPE=Release", "-DMICROTIN_WERROR=ON", "-DMICROTIN_TESTS=OFF", "-DMICROTIN_TOOLS=ON",
             "-DMICROTIN_QGIS_DRIVER=ON", f"-DMICROTIN_GDAL_DRIVER={gdal}")  # fmt: skip
    must_run("cmake", "--build", folder, "--target", "microtin_decoder")
    found = [*faults(folder, version), *missed(folder)]
    for fault in found:
        print(f"rejected: {fault}")
    links = len(list(links_of(folder)))
    print(f"macOS: {links} files are linked with lld, {len(found)} rejected; the encoder is not compiled")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
