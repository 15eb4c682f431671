# SPDX-License-Identifier: MIT
"""bundle.py MODULE.wasm VERSION URL FOLDER: makes the npm package: the sources with the WebAssembly within as one module,
and what accompanies it. With zopfli and esbuild."""
import base64
import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
BESIDE = "README.md cesium.js cesium.d.ts loader.js loader.d.ts microtin.d.ts".split()


def output(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout


def module(wasm, version):
    """The text of the module."""
    text = base64.b64encode(output("zopfli", "-c", "--deflate", wasm)).decode()
    return output("esbuild", HERE / "src/index.js", "--bundle", "--minify", "--format=esm", "--target=es2022",
                  "--log-level=warning", f"--banner:js=// SPDX-License-Identifier: MIT\n// microtin {version}",
                  f"--define:MICROTIN_WASM={json.dumps(text)}", f"--define:MICROTIN_VERSION={json.dumps(version)}")


def main(wasm, version, url, folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "microtin.js").write_bytes(module(wasm, version))
    description = (HERE / "package.json").read_text().replace("@VERSION@", version).replace("@URL@", url)
    (folder / "package.json").write_text(description)
    for file in [*(HERE / name for name in BESIDE), ROOT / "LICENSE"]:
        shutil.copy(file, folder)


main(*sys.argv[1:])
