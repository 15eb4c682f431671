# SPDX-License-Identifier: MIT
"""layouts.py TARGET BITS [--write] [--headers FOLDER] COMPILER...: on a target, whose indices have BITS bits, the sizes
of the public structs, the places of their members, and the bytes of the caller's memory are those of layouts.txt. COMPILER
is the command that compiles C++ for the target, with its flags. --write records them. The cores of a family have one
column. Exits with 77 if the target has none."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECORD = Path(__file__).with_name("layouts.txt")
ABSENT = "-"
# Arguments of the macros of the caller's memory that every target can have.
ARGUMENTS = {"capacity": 500, "vertices": 500, "side": 8}
OF_PACKS = {"slots": 4, "capacity": 100, "tile_bytes": 1000}


def members(body):
    """The names that a struct's body declares."""
    for declaration in re.sub(r"/\*.*?\*/", "", body, flags=re.S).split(";"):
        pointer = re.search(r"\(\*(\w+)\)", declaration)
        names = [pointer.group(1)] if pointer else re.findall(r"(\w+)\s*(?:\[[^]]*\])?\s*(?:,|$)", declaration.strip())
        yield from names


def expressions(headers, names):
    """What is recorded: the text of each constant, by its name."""
    found = {}
    for name in names:
        text = (headers / "microtin" / name).read_text()
        for struct, body in re.findall(r"^typedef struct (\w+) \{\n(.*?)^\} \w+;", text, re.S | re.M):
            found[struct] = f"sizeof({struct})"
            for member in members(body):
                found[f"{struct}.{member}"] = f"__builtin_offsetof({struct}, {member})"
        for macro, names in re.findall(r"^#define (MICROTIN_\w+_BYTES)\(([\w, ]+)\)", text, re.M):
            values = OF_PACKS if "slots" in names else ARGUMENTS
            call = f"{macro}({', '.join(str(values[name]) for name in names.split(', '))})"
            found[call] = call
    return found


def measured(target, bits, headers, compiler):
    """The constants, from the text that the compiler would pass to the assembler; nothing is run."""
    decoder = ROOT / "decoder/include" if headers is None else headers
    names = sorted(path.name for path in (decoder / "microtin").glob("*.h") if path.name != "config.h")
    wanted = expressions(decoder, names)
    lines = [f'#include "microtin/{name}"' for name in names]
    if target == "x86_64":  # the encoder's structs, which hosts alone have
        encoder = ROOT / "encoder/include"
        wanted = {**wanted, **expressions(encoder, ["encoder.h"])}
        lines.append('#include "microtin/encoder.h"')
    lines.append("void layouts() {")
    for name, constant in wanted.items():
        lines.append(f'__asm__ volatile("\\n.ascii \\"-> {name} = %0 \\"" : : "i"(static_cast<long>({constant})));')
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "layouts.cpp"
        source.write_text("\n".join([*lines, "}\n"]))
        includes = [f"-I{decoder}", f"-I{ROOT / 'encoder/include'}", f"-DMICROTIN_INDEX_BITS={bits}"]
        flags = ["-x", "c++", "-std=c++14", "-w", "-ffreestanding", "-S", str(source), "-o", "-"]
        text = subprocess.run([*compiler, *includes, *flags], check=True, stdout=subprocess.PIPE, text=True).stdout
    values = dict(re.findall(r"-> ([^=\n]+) = [#$]?(\d+) ", text))
    missing = [name for name in wanted if name not in values]
    assert not missing, f"not in the compiler's output: {missing}"
    return values


def read():
    """A dictionary of values for each target."""
    table = {}
    for line in RECORD.read_text().splitlines() if RECORD.exists() else []:
        if line and not line.startswith("#"):
            name, *cells = re.split(r" *\| *", line)
            if name == "name":
                targets = cells
            else:
                for target, cell in zip(targets, cells):
                    if cell != ABSENT:
                        table.setdefault(target, {})[name] = cell
    return table


def write(table):
    targets = sorted(table)
    names = list(dict.fromkeys(name for target in sorted(table, key=lambda t: -len(table[t])) for name in table[target]))
    rows = [["name", *targets], *([name, *(table[target].get(name, ABSENT) for target in targets)] for name in names)]
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = [" | ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
    head = "# Sizes of the public structs and places of their members, in bytes. Written by tests/abi/layouts.py --write.\n"
    RECORD.write_text(head + "\n".join(lines) + "\n")


def main():
    arguments = sys.argv[1:]
    target, bits = re.sub(r"^(cortex-m|rv32).*", r"\1", arguments.pop(0)), arguments.pop(0)
    is_written = arguments[0] == "--write"
    arguments = arguments[is_written:]
    headers = Path(arguments[1]) if arguments[0] == "--headers" else None
    table = read()
    if target not in table and not is_written:
        print(f"skipped: layouts.txt has no column for {target}")
        sys.exit(77)
    values = measured(target, bits, headers, arguments[2:] if headers else arguments)
    if is_written:
        write({**table, target: values})
        return
    recorded = table[target]
    faults = [
        f"rejected: {name} is {values.get(name, ABSENT)}, recorded {recorded.get(name, ABSENT)}"
        for name in dict.fromkeys([*recorded, *values])
        if values.get(name) != recorded.get(name)
    ]
    print("\n".join([*faults, f"{target}: {len(values)} constants, {len(faults)} rejected"]))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
