# SPDX-License-Identifier: MIT
"""examples.py CC CXX [FOLDER]: every block of C and C++ in the documents of the project, or of a folder, compiles without a
warning. A block with a function is a file, any other is the body of a function."""

import re
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from conventions import ROOT, documents  # noqa: E402

READ_CARD = "int32_t read_card(void* context, uint64_t offset, uint8_t* buffer, size_t size);\n"
# What the text around a block leaves to the reader.
BEFORE = {
    "decoder/docs/autopilots.md": '#include "adapters/ardupilot.h"\n#include "adapters/inav.h"\n'
    + READ_CARD
    + "static const microtin_card_driver driver;\nextern int32_t gps_lat, gps_lon, home_lat, home_lon, is_home_new;\n"
    "uint32_t millis(void);\nvoid terrain_init(void), terrain_update(void), update(void), io_timer(void);\n"
    "bool terrain_is_healthy(void);\nstatic microtin_ardupilot terrain;\nstatic microtin_inav inav;\n",
    "decoder/docs/decoding.md": "size_t read_radio(uint8_t* bytes, size_t most);\n",
    "decoder/docs/memory.md": "static microtin::Terrain<5000> terrain;\nstatic microtin::Decoder<5000> decoder(terrain);\n",
    "decoder/docs/packs.md": READ_CARD
    + "static microtin_pack* pack;\nstatic int64_t x, y, x_ahead, y_ahead;\nstatic int card;\nstatic uint32_t hint;\nstatic int32_t height;\n",
    "decoder/docs/queries.md": "static microtin::Terrain<5000> terrain;\nstatic int32_t x, y, height;\nstatic uint32_t hint;\nvoid use(int32_t height);\nvoid keep_above(int32_t height);\n"
    "static const uint8_t* bytes;\nstatic size_t size;\nvoid stay_away(void);\n",
    "decoder/docs/rtos.md": READ_CARD + "void lock(void), unlock(void), sleep_ms(int milliseconds);\n",
    "encoder/docs/library.md": "#include <stdio.h>\n#include <string.h>\nstatic uint32_t columns, rows;\n"
    "static const float* heights;\n#ifdef __cplusplus\nstatic microtin::encoder::Transform transform;\n"
    "void save(const std::vector<uint8_t>& bytes);\nstd::string name_of(const microtin::encoder::Shard& shard);\n"
    "static microtin::encoder::Options options;\nstatic std::vector<std::string> shard_files;\n#else\nstatic double transform[6];\n"
    "void save(const uint8_t* bytes, uint64_t byte_count);\n#endif\n",
}
HEADERS = {"c": ("requests.h",), "cpp": ("microtin.hpp", "compact_pack.hpp", "requests.h", "edge_marks.h")}
HOSTED = {"c": ("encoder.h",), "cpp": ("encoder.hpp", "surface.hpp")}
FUNCTION = re.compile(r"^(?!if|for|while|switch)\w[^;=\n]*\) \{", re.M)
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-Wno-unused-variable", "-Wno-unused-but-set-variable",
            "-Wno-unused-function"]


def blocks(document):
    """Language, number of the first line and text of each block of C and C++."""
    text = document.read_text()
    for match in re.finditer(r"^```(c|cpp|c\+\+)\n(.*?)^```", text, re.M | re.S):
        yield "c" if match[1] == "c" else "cpp", text.count("\n", 0, match.start(2)) + 1, match[2]


def program(name, language, line, block):
    hosted = name.startswith("encoder/")
    headers = HOSTED[language] if hosted else HEADERS[language]
    before = "".join(f'#include "microtin/{header}"\n' for header in headers) + BEFORE.get(name, "")
    code = f'#line {line} "{name}"\n{block}'
    if not FUNCTION.search(block):
        code = f"void example(void);\nvoid example(void) {{\n{code}}}\n"
    standard = "c99" if language == "c" else "c++17" if hosted else "c++14"
    return [f"-std={standard}", "-x", "c" if language == "c" else "c++"], before + code


def main():
    compilers = {"c": sys.argv[1], "cpp": sys.argv[2]}
    folder = Path(sys.argv[3]) if len(sys.argv) > 3 else ROOT
    includes = [f"-I{ROOT / part}/include" for part in ("decoder", "encoder")] + [f"-I{ROOT}/decoder"]
    compiled = rejected = 0
    for document in documents(folder):
        name = str(document.relative_to(folder))
        for language, line, block in blocks(document):
            flags, text = program(name, language, line, block)
            command = [compilers[language], *flags, *WARNINGS, *includes, "-fsyntax-only", "-"]
            run = subprocess.run(command, input=text, capture_output=True, text=True)
            compiled += 1
            if run.returncode != 0:
                rejected += 1
                print(f"rejected: {name}:{line}\n{run.stderr}")
    print(f"{compiled} examples, {rejected} rejected")
    sys.exit(1 if rejected or not compiled else 0)


main()
