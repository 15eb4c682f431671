# SPDX-License-Identifier: MIT
"""amalgamate.py FOLDER: writes the decoder as one header and one source, microtin.h and microtin.cpp, to be added to
any firmware's sources. The header serves C and C++; the source is C++14."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PUBLIC = ROOT / "decoder/include"

INCLUDE = re.compile(r'^#include "(.*)"\n', re.M)
LICENCE = re.compile(r"^// SPDX-License-Identifier: .*\n", re.M)
GUARD = re.compile(r"^#ifndef (\w+)\n#define \1\n", re.M)


def parts(path):
    """A header's comment and what its include guard holds; of a source, nothing and all."""
    text = LICENCE.sub("", path.read_text())
    guard = GUARD.search(text)
    if path.suffix == ".cpp" or not guard:
        return "", text
    return text[: guard.start()], text[guard.end() : text.rindex("#endif")]


def without_guard(path):
    return "".join(parts(path))


def expanded(path, seen):
    """A file's text with each file of the project that it includes in place, once."""

    def include(match):
        if match[1].startswith("microtin/"):
            return ""
        inner = ROOT / match[1]
        if inner in seen:
            return ""
        seen.add(inner)
        return expanded(inner, seen)

    return f"// --- {path.relative_to(ROOT)}\n" + INCLUDE.sub(include, without_guard(path))


def header():
    comment, c_face = parts(PUBLIC / "microtin/microtin.h")
    compact, pack, compact_pack, cpp_face, cpp_pack, cpp_compact_pack = (
        INCLUDE.sub("", without_guard(PUBLIC / "microtin" / name))
        for name in (
            "compact.h", "pack.h", "compact_pack.h", "microtin.hpp", "pack.hpp", "compact_pack.hpp"
        )
    )
    return (
        f"{comment}#ifndef MICROTIN_H\n#define MICROTIN_H\n{c_face}\n{compact}\n{pack}\n{compact_pack}"
        f"#ifdef __cplusplus\n\n{cpp_face}\n{cpp_pack}\n{cpp_compact_pack}\n#endif\n\n#endif\n"
    )


# Constants of the format that only the encoder uses; clang accepts them in a header.
QUIET = """#if defined(__clang__)
#pragma clang diagnostic ignored "-Wunused-const-variable"
#endif
"""


def source():
    seen = set()
    files = "".join(expanded(path, seen) for path in sorted((ROOT / "decoder").glob("*.cpp")))
    return f'#include "microtin.h"\n\n{QUIET}\n{files}'


def version():
    text = (PUBLIC / "microtin/microtin.h").read_text()
    return ".".join(re.findall(r"^#define MICROTIN_VERSION_\w+ (\d+)$", text, re.M))


folder = Path(sys.argv[1])
folder.mkdir(parents=True, exist_ok=True)
notice = f"""// SPDX-License-Identifier: MIT
/* microtin {version()}, the decoder in two files, made by decoder/amalgamate.py.

{(ROOT / "LICENSE").read_text()}*/
"""
(folder / "microtin.h").write_text(notice + header())
(folder / "microtin.cpp").write_text(notice + source())
