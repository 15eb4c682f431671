# SPDX-License-Identifier: MIT
"""notes.py VERSION FOLDER: prints the release notes: the section of VERSION in CHANGELOG.md (in a trial, where there is
none, that of "Unreleased"), and what each file of FOLDER is for."""

import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from refusals import section  # noqa: E402

PURPOSES = (
    ("-source.tar.gz", "the sources, with the page of `render` generated"),
    ("-linux-x86_64.tar.gz", "the program for Linux, one static file, with its manual page and completions"),
    ("-windows-x86_64.zip", "the program for 64-bit Windows, one static file"),
    (".whl", "the Python package, built"),
    ("-arduino.zip", "the decoder as an Arduino library"),
    ("-platformio.tar.gz", "the decoder as a PlatformIO library"),
    ("-esp-idf.zip", "the decoder as a component of ESP-IDF"),
    ("-zephyr.zip", "the decoder as a Zephyr module"),
    ("-meson.zip", "the decoder as a subproject of Meson, with its wrap"),
    (".pack", "the decoder as a CMSIS-Pack"),
    (".tgz", "the npm package"),
    (".tar.gz", "the Python package, sources"),
)


def purpose(name):
    return next((text for end, text in PURPOSES if name.endswith(end)), None)


def notes(version, changes, names):
    lines = [f"# microtin {version}", "", changes.rstrip("\n"), "", "## Files", "", "| file | content |", "|---|---|"]
    lines += [f"| {name} | {purpose(name)} |" for name in sorted(names) if purpose(name)]
    lines += [f"| microtin-{version}.spdx.json | the list of parts and licences (SBOM, SPDX 2.3) |",
              "| SHA256SUMS | checksums: `sha256sum -c SHA256SUMS` |"]
    return "\n".join(lines) + "\n"


def main():
    version, folder = sys.argv[1], Path(sys.argv[2])
    text = Path("CHANGELOG.md").read_text()
    found = section(text, version) or section(text, "Unreleased")
    if not found:
        sys.exit(f"CHANGELOG.md: has neither a section of {version} nor of Unreleased; write one")
    sys.stdout.write(notes(version, found[0], [path.name for path in folder.iterdir()]))


if __name__ == "__main__":
    main()
