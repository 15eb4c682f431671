#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""amalgamate.py FOLDER: writes the decoder to be added to any firmware's sources: one source, microtin.cpp (C++14), the
public headers under the paths that they have everywhere, microtin/..., and microtin.h, which includes them all, for C
and C++. FOLDER goes among the paths of includes."""

import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PUBLIC = ROOT / "decoder/include"

INCLUDE = re.compile(r'^#include "(.*)"\n', re.M)
LICENCE = re.compile(r"^// SPDX-License-Identifier: .*\n", re.M)
GUARD = re.compile(r"^#ifndef (\w+)\n#define \1\n", re.M)
NAMESPACE = re.compile(r"^(namespace microtin \{\n)(.*?)^\}  // namespace microtin\n", re.M | re.S)

# Nobody else sees what the source defines, so the compiler need not keep it apart; clang gets the
# threshold of -Oz at -Os, since what it inlines there makes the decoder a third larger than gcc's.
BEGIN = """#if defined(__clang__)
#pragma clang diagnostic ignored "-Wunused-const-variable"
#pragma clang diagnostic ignored "-Wunused-function"
#if defined(__OPTIMIZE_SIZE__)
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#endif
#endif
"""
END = """
#if defined(__clang__) && defined(__OPTIMIZE_SIZE__)
#pragma clang attribute pop
#endif
"""

HEADER = """#ifndef MICROTIN_H
#define MICROTIN_H

#include "microtin/compact.h"
#include "microtin/compact_pack.h"
#include "microtin/edge_marks.h"
#include "microtin/requests.h"
#include "microtin/segment.h"
#include "microtin/microtin.h"
#include "microtin/pack.h"
#ifdef __cplusplus
#include "microtin/compact_pack.hpp"
#include "microtin/microtin.hpp"
#include "microtin/pack.hpp"
#endif

#endif
"""


def version():
    text = (PUBLIC / "microtin/microtin.h").read_text()
    return ".".join(re.findall(r"^#define MICROTIN_VERSION_\w+ (\d+)$", text, re.M))


def notice():
    return f"""// SPDX-License-Identifier: MIT
/* microtin {version()}, the decoder in one source, made by decoder/amalgamate.py.

{(ROOT / "LICENSE").read_text()}*/
"""


def without_guard(path):
    text = LICENCE.sub("", path.read_text())
    guard = GUARD.search(text)
    if path.suffix == ".cpp" or not guard:
        return text
    return text[guard.end() : text.rindex("#endif")]


def expanded(path, seen):
    """A file's text with each file of the project that it includes in place, once, and in a namespace without name."""

    def include(match):
        if match[1].startswith("microtin/"):
            return ""
        inner = ROOT / match[1]
        if inner in seen:
            return ""
        seen.add(inner)
        return expanded(inner, seen)

    text = NAMESPACE.sub(r"\1namespace {\n\2}  // namespace\n}  // namespace microtin\n", without_guard(path))
    return f"// --- {path.relative_to(ROOT)}\n" + INCLUDE.sub(include, text)


def source():
    seen = set()
    files = "".join(expanded(path, seen) for path in sorted((ROOT / "decoder").glob("*.cpp")))
    return f'#include "microtin.h"\n\n{BEGIN}\n{files}{END}'


def amalgamate(folder):
    shutil.copytree(PUBLIC / "microtin", folder / "microtin", dirs_exist_ok=True)
    (folder / "microtin.h").write_text(notice() + HEADER)
    (folder / "microtin.cpp").write_text(notice() + source())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    amalgamate(Path(sys.argv[1]))
