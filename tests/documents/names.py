# SPDX-License-Identifier: MIT
"""names.py [PAGE]: the page of public names, shared/docs/names.md or PAGE, has each name that users of C and C++, of the
commands and their reports, of Python, npm, GDAL, CMake and Kconfig write, and no name that does not exist.

A name that begins with "_" ends as it says, and begins as the name before it in its cell does; "*" stands for any letters;
"the same of `compact`" adds the names with that word in place of "mesh"."""

import ast
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
C_HEADERS = (*ROOT.glob("decoder/include/microtin/*.h"), ROOT / "encoder/include/microtin/encoder.h")
CPP_HEADERS = (*ROOT.glob("decoder/include/microtin/*.hpp"), *ROOT.glob("encoder/include/microtin/*.hpp"))
ADAPTERS = tuple(ROOT.glob("decoder/adapters/*.h*"))
# What includes, links and versions need, and nobody writes.
C_ASIDE = re.compile(r"MICROTIN_\w+_H|microtin_\w+_(16|32)|microtin_config|microtin_phase")


def text_of(path):
    """Without comments."""
    return re.sub(r"/\*.*?\*/|//[^\n]*", "", path.read_text(), flags=re.S)


def words_in(paths, pattern):
    return {word for path in paths for word in re.findall(pattern, text_of(path))}


class Page:
    def __init__(self, path):
        self.sections, heading = {}, ""
        for line in path.read_text().splitlines():
            if line.startswith(("## ", "### ")):
                heading = line.lstrip("# ")
            self.sections.setdefault(heading, []).append(line)

    def cells(self, heading):
        """The first cell of each row of the section's tables, and its paragraphs."""
        lines = self.sections.get(heading, [])
        cells = [line.split(" | ")[0].lstrip("| ") if line.startswith("| ") else line for line in lines]
        text = [line for line in cells if not line.startswith("|--")]
        return [cell for cell in text if "`" in cell]

    def names(self, heading):
        return [name for cell in self.cells(heading) for name in re.findall(r"`([^`]+)`", cell)]


class Expected:
    """Names of a page's cells that are shortened: each has the forms that it may stand for."""

    def __init__(self, cells):
        self.items = []
        for cell in cells:
            before = ""
            for name in re.findall(r"`(\*?_?(?:microtin_|MICROTIN_)?[\w*]+)`", cell):
                if name.startswith("_") and before:
                    self.items.append((before, name))
                elif name.lower().startswith("microtin_"):
                    before = name
                    self.items.append((name, ""))
            others = re.findall(r"`(\w+)`", cell.partition("the same of")[2])
            same = [name for name, end in self.items[-9:] if not end and "microtin_mesh_" in name and f"`{name}`" in cell]
            self.items += [(name.replace("mesh", other), "") for other in others if other.islower() for name in same]

    @staticmethod
    def stands_for(item, name):
        start, end = item
        if end:
            return name.endswith(end) and start.startswith(name[: -len(end)])
        return re.fullmatch(start.replace("*", r"\w+"), name) is not None

    def missing(self, names):
        return sorted(name for name in names if not any(self.stands_for(item, name) for item in self.items))

    def unknown(self, names):
        return sorted(f"{start} {end}".strip() for start, end in self.items if not any(self.stands_for((start, end), name) for name in names))


def c_faults(page):
    headings = [heading for heading in page.sections if heading.startswith("C, on")]
    expected = Expected([cell for heading in headings for cell in page.cells(heading)])
    names = {name for name in words_in(C_HEADERS, r"\b(?:microtin|MICROTIN)_\w+") if not C_ASIDE.fullmatch(name)}
    yield from (f"C: {name} is not on the page" for name in expected.missing(names))
    others = {word for path in (*ADAPTERS, ROOT / "decoder/include/microtin/config.h")
              for word in re.findall(r"\b(?:microtin|MICROTIN)_\w+", path.read_text())}
    yield from (f"C: there is no {name}" for name in expected.unknown(names | others))


def cpp_faults(page):
    known = words_in(CPP_HEADERS, r"\w+")
    listed = {word for name in page.names("C++") for word in re.findall(r"\w+", name)} - {"microtin", "encoder"}
    yield from (f"C++: there is no {word}" for word in sorted(listed - known))
    types = set()
    for path in CPP_HEADERS:
        types |= set(re.findall(r"^(?:class|struct|enum class) (\w+)(?! \w)", text_of(path), re.M))
    yield from (f"C++: {name} is not on the page" for name in sorted(types - listed))


def option_faults(page):
    record = (ROOT / "tests/abi/commands.txt").read_text()
    options = set(re.findall(r"^option [\w ]+ --([\w-]+)", record, re.M)) - {"help", "version"}
    header = text_of(ROOT / "encoder/include/microtin/encoder.hpp")
    members = set(re.findall(r"\b(\w+)\b", header.split("struct Options {")[1].split("\n};")[0]))
    listed = {name.split()[0].lstrip("-") for name in page.names("Options")}
    yield from (f"options: {name} is not on the page" for name in sorted(options - listed))
    spelled = options | {member.replace("_", "-") for member in members} | members | {"crs", "allow-vrt", "band"}
    yield from (f"options: there is no {name}" for name in sorted(listed - spelled))
    driver = (ROOT / "encoder/gdal/create_copy.cpp").read_text()
    for name in re.findall(r'"([A-Z_]+)"', driver.split("kCreationOptions[] = {")[1].split("}")[0]):
        if name.lower() not in members:
            yield f"GDAL: {name} is not an option of the library"


def key_faults(page):
    record = (ROOT / "tests/abi/commands.txt").read_text()
    keys = {}
    for command, key in re.findall(r"^key (\w+) \.(\w+) ", record, re.M):
        keys.setdefault(command, set()).add(key)
    rows = {}
    for line in page.sections.get("Keys of reports", []):
        names = re.findall(r"`(\w+)`", line)
        if line.startswith("| `"):
            rows[names[0]] = set(names[1:])
    for command in sorted(keys | rows):
        there, listed = keys.get(command, set()), rows.get(command, set())
        yield from (f"keys of {command}: {key} is not on the page" for key in sorted(there - listed))
        yield from (f"keys of {command}: there is no {key}" for key in sorted(listed - there))


def members_of(node):
    for part in node.body:
        if isinstance(part, ast.AnnAssign):
            yield part.target.id
        elif isinstance(part, ast.FunctionDef):
            yield part.name
            if part.name == "__init__":
                stored = (one for one in ast.walk(part) if isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Store))
                yield from (one.attr for one in stored)


def python_faults(page):
    folder = ROOT / "encoder/python/microtin"
    public = set(ast.literal_eval(re.search(r"__all__ = (\[.*\])", (folder / "__init__.py").read_text())[1]))
    names = set(public)
    for path in folder.glob("_*.py"):
        if path.name == "_library.py":
            continue
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ClassDef) and node.name in public:
                names |= {f"{node.name}.{member}" for member in members_of(node) if not member.startswith("_")}
    yield from rows_faults("Python", page, names)


def npm_faults(page):
    text = text_of(ROOT / "decoder/packages/npm/microtin.d.ts")
    names = set()
    for kind, name, body in re.findall(r"^export (class|interface|const|type|function) (\w+)([^{;]*\{\n.*?^\})?", text, re.M | re.S):
        names.add(name)
        if kind in ("class", "interface") and body:
            members = re.findall(r"^  (?:static |readonly )*(\w+)\??[:(]", body, re.M)
            names |= {f"{name}.{member}" for member in members}
    yield from rows_faults("npm", page, names)


def rows_faults(heading, page, names):
    """Rows of such a section have a name, and its members in the second cell."""
    listed = set()
    for line in page.sections.get(heading, []):
        found = re.findall(r"`(\w+)`", line)
        if line.startswith("| `"):
            listed |= {found[0], *(f"{found[0]}.{member}" for member in found[1:])}
    yield from (f"{heading}: {name} is not on the page" for name in sorted(names - listed))
    yield from (f"{heading}: there is no {name}" for name in sorted(listed - names))


def build_faults(page):
    lists = (ROOT / "CMakeLists.txt", *ROOT.glob("decoder/CMakeLists.txt"), *ROOT.glob("encoder/**/CMakeLists.txt"))
    texts = [path.read_text() for path in lists]
    variables = {name for text in texts for name in re.findall(r"option\((MICROTIN_\w+) |set\((MICROTIN_\w+) [^\n]* CACHE STRING", text)}
    variables = {one or other for one, other in variables}
    switches = re.search(r"foreach\(switch ([A-Z_ ]+)\)", "\n".join(texts))
    variables |= {f"MICROTIN_{name}" for name in switches[1].split()} if switches else set()
    kconfig = (ROOT / "decoder/packages/zephyr/zephyr/Kconfig").read_text()
    symbols = set(re.findall(r"^(?:menuconfig|config|choice) (\w+)", kconfig, re.M))
    for heading, names in (("CMake", variables), ("Kconfig", symbols)):
        listed = {name for name in page.names(heading) if re.fullmatch(r"MICROTIN\w*", name)}
        yield from (f"{heading}: {name} is not on the page" for name in sorted(names - listed))
        yield from (f"{heading}: there is no {name}" for name in sorted(listed - names))


def main():
    page = Page(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "shared/docs/names.md")
    checks = (c_faults, cpp_faults, option_faults, key_faults, python_faults, npm_faults, build_faults)
    found = [fault for check in checks for fault in check(page)]
    for fault in found:
        print(f"rejected: {fault}")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
