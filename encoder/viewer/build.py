# SPDX-License-Identifier: MIT
"""build.py MICROTIN.js OUTPUT.cpp: the page that shows a terrain, with places for it, as a source of the program.
With esbuild."""
import json
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def bundled(entry, *options):
    return subprocess.run(["esbuild", HERE / entry, "--bundle", "--minify", "--format=iife", "--target=es2022",
                           "--charset=utf8", "--log-level=warning", *options],
                          check=True, stdout=subprocess.PIPE).stdout.decode().strip()


def page(module):
    decoder = bundled("decoder.js", f"--alias:microtin={Path(module).resolve()}")
    script = bundled("main.js", f"--define:VIEWER_DECODER={json.dumps(decoder)}",
                     f"--define:VIEWER_DRAWER={json.dumps(bundled('drawer.js'))}")
    text = (HERE / "page.html").read_text()
    for place, content in {"STYLE": (HERE / "style.css").read_text(), "SCRIPT": script}.items():
        text = text.replace(f"@{place}@", content.strip())
    return text


def source(text):
    numbers = [str(byte) for byte in text.encode()]
    lines = ",\n".join(",".join(numbers[i : i + 32]) for i in range(0, len(numbers), 32))
    return f"""// SPDX-License-Identifier: MIT
// Made by encoder/viewer/build.py.
#include "encoder/picture/render.hpp"

namespace microtin::picture {{

// NOLINTBEGIN
static const unsigned char kPage[] = {{
{lines}}};

std::string_view viewer_page() {{
  return {{reinterpret_cast<const char*>(kPage), sizeof kPage}};
}}
// NOLINTEND

std::string_view viewer_absence() {{
  return {{}};
}}

}}  // namespace microtin::picture
"""


Path(sys.argv[2]).write_text(source(page(sys.argv[1])))
