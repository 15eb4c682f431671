# SPDX-License-Identifier: MIT
"""rules.py KIND FOLDER: a package that decoder/packages/make wrote keeps the rules of its ecosystem; what it names is
there. The rules are ours, written from what each ecosystem publishes, which the functions name."""

import json
import re
import subprocess
import sys
from pathlib import Path

SEMANTIC = r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)"
HERE = Path(__file__).resolve().parent
BUDGET = json.loads((HERE.parent / "footprint/budget.json").read_text())
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE.parent / "footprint"))

import boards  # noqa: E402


class Faults(list):
    def unless(self, condition, text):
        if not condition:
            self.append(text)

    def files(self, folder, names):
        for name in names:
            self.unless((folder / name).exists(), f"{name} is not there")


def stamp(library):
    text = (library / "src/microtin/microtin.h").read_text()
    return ".".join(re.findall(r"^#define MICROTIN_VERSION_\w+ (\d+)$", text, re.M))


def common(library):
    """What each package has: the licence, and one version, that of its header."""
    faults = Faults()
    faults.files(library, ["LICENSE", "README.md", "src/microtin.h", "src/microtin.cpp", "src/microtin/config.h"])
    for path in library.rglob("*"):
        faults.unless(not path.is_symlink(), f"{path.name} is a link")
        if path.is_file() and path.suffix != ".cpp":
            faults.unless(not re.search(r"@[A-Z]+@", path.read_text()), f"{path.name} has a place that was not filled")
    faults.unless(stamp(library) in (library / "src/microtin.cpp").read_text()[:200], "microtin.cpp has another version")
    return faults


def least_flash(library, faults):
    """The limit of board.cpp refuses the AVR boards that do not fit, and no others."""
    [last] = re.findall(r"FLASHEND < 0x([0-9A-F]+)", (library / "src/board.cpp").read_text())
    for fault in boards.faults_of_limit(BUDGET, int(last, 16) + 1):
        faults.append(fault)


def names_boards(given, fitting, faults):
    """A library that does not link on small boards must not name them, nor leave out those on which it fits."""
    given = set(given)
    faults.unless(given <= fitting, f"no board that fits: {', '.join(sorted(given - fitting))}")
    faults.unless(fitting <= given, f"boards that fit are not named: {', '.join(sorted(fitting - given))}")


def arduino(folder):
    """Arduino's library specification, 1.5 format (arduino.github.io/arduino-cli, "Library specification"), and what
    arduino-lint asks beyond it of the library manager's entries."""
    library = folder / "microtin"
    faults = common(library)
    lines = (library / "library.properties").read_text().splitlines()
    faults.unless(all("=" in line for line in lines), "library.properties has a line without =")
    fields = dict(line.split("=", 1) for line in lines if "=" in line)
    for name in ("name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures"):
        faults.unless(fields.get(name, "").strip(), f"{name} is missing")
    names_boards(fields.get("architectures", "").split(","), boards.architectures(BUDGET), faults)
    least_flash(library, faults)
    name = fields.get("name", "")
    faults.unless(re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9 _.-]{0,62}", name), "the name has other characters")
    faults.unless("arduino" not in name.lower(), "the name speaks of Arduino")
    faults.unless(re.fullmatch(SEMANTIC, fields.get("version", "")), "the version is not x.y.z")
    faults.unless(fields.get("version") == stamp(library), "the version is not the header's")
    faults.unless(
        fields.get("category")
        in ("Display", "Communication", "Signal Input/Output", "Sensors", "Device Control", "Timing", "Data Storage",
            "Data Processing", "Other"),
        "there is no such category",
    )  # fmt: skip
    faults.unless(re.match(r"https?://\w", fields.get("url", "")), "the url is none")
    faults.unless(not fields.get("paragraph", "").startswith(fields.get("sentence", "-")), "the paragraph repeats")
    faults.files(library / "src", filter(None, fields.get("includes", "").split(",")))
    faults.unless(not (library / "utility").exists(), "src and utility exclude each other")
    sketches = [path for path in (library / "examples").iterdir() if path.is_dir()]
    faults.unless(sketches, "there is no example")
    faults.files(library / "examples", [f"{sketch.name}/{sketch.name}.ino" for sketch in sketches])
    return faults


def platformio(folder):
    """PlatformIO's documentation of library.json, field by field (docs.platformio.org, "library.json")."""
    library = folder / "microtin"
    faults = common(library)
    manifest = json.loads((library / "library.json").read_text())
    known = {"name", "version", "description", "keywords", "homepage", "repository", "authors", "license", "frameworks",
             "platforms", "headers", "examples", "dependencies", "export", "scripts", "build"}  # fmt: skip
    faults.unless(not set(manifest) - known, f"unknown fields {set(manifest) - known}")
    name = manifest.get("name", "")
    faults.unless(re.fullmatch(r"[^:;/,@<>]{1,100}", name) and "--" not in name, "the name has other characters")
    faults.unless(manifest.get("version") == stamp(library), "the version is not the header's")
    faults.unless(len(manifest.get("description", "")) in range(1, 256), "the description is missing or long")
    keywords = manifest.get("keywords", [])
    faults.unless(all(re.fullmatch(r"[a-z0-9 ._-]{1,50}", word) for word in keywords), "a keyword is not small")
    faults.unless(manifest.get("license") == "MIT", "the licence is not the project's, by its SPDX name")
    faults.unless(all("name" in author for author in manifest.get("authors", [])), "an author without a name")
    names_boards(manifest.get("platforms", []), boards.platforms(BUDGET), faults)
    least_flash(library, faults)
    build = manifest.get("build", {})
    places = {"flags", "unflags", "includeDir", "srcDir", "srcFilter", "extraScript", "libArchive", "libLDFMode",
              "libCompatMode", "builder"}  # fmt: skip
    faults.unless(not set(build) - places, f"unknown fields of build {set(build) - places}")
    faults.files(library, [build.get("srcDir", "src"), build.get("includeDir", "include")])
    includes = library / build.get("includeDir", "include")
    named = set(manifest.get("headers", []))
    faults.files(includes, named)
    there = {str(path.relative_to(includes)) for path in includes.rglob("*.h*")}
    faults.unless(there - named <= {"microtin/config.h"}, f"headers that are not named: {there - named}")
    return faults


def yaml_of(path):
    import yaml

    return yaml.safe_load(path.read_text())


def esp_idf(folder):
    """The manifest of the IDF component manager (docs.espressif.com, "idf_component.yml manifest file")."""
    library = folder / "microtin"
    faults = common(library)
    manifest = yaml_of(library / "idf_component.yml")
    known = {"version", "description", "url", "repository", "documentation", "issues", "discussion", "license", "tags",
             "targets", "maintainers", "dependencies", "files", "examples", "repository_info"}  # fmt: skip
    faults.unless(not set(manifest) - known, f"unknown fields {set(manifest) - known}")
    faults.unless(manifest.get("version") == stamp(library), "the version is not the header's")
    faults.unless(re.match(r"https?://\w", manifest.get("url", "")), "the url is none")
    faults.unless(all(re.fullmatch(r"[a-z0-9_-]{3,32}", tag) for tag in manifest.get("tags", [])), "a tag is not one")
    ranges = manifest.get("dependencies", {}).values()
    faults.unless(all(re.match(r"([<>=~^]=?)?\d", str(r)) for r in ranges), "a dependency has no range of versions")
    script = (library / "CMakeLists.txt").read_text()
    faults.unless("idf_component_register(" in script, "the component is not registered")
    faults.unless(
        script.find("if(ESP_PLATFORM)") in range(script.find("project(")), "IDF is asked behind project()"
    )
    return faults


def zephyr(folder):
    """The keys of module.yml (docs.zephyrproject.org, "Modules (External projects)"), and Kconfig by kconfiglib."""
    library = folder / "microtin"
    faults = common(library)
    module = yaml_of(library / "zephyr/module.yml")
    known = {"name", "build", "tests", "samples", "boards", "blobs", "security", "package-managers", "runners"}
    faults.unless(not set(module) - known, f"unknown keys {set(module) - known}")
    build = module.get("build", {})
    places = {"cmake", "kconfig", "cmake-ext", "kconfig-ext", "depends", "settings", "sysbuild-cmake",
              "sysbuild-kconfig", "sysbuild-cmake-ext", "sysbuild-kconfig-ext"}  # fmt: skip
    faults.unless(not set(build) - places, f"unknown keys of build {set(build) - places}")
    faults.files(library, [build.get("cmake", "zephyr") + "/CMakeLists.txt", build.get("kconfig", "zephyr/Kconfig")])
    return faults


def cmsis_pack(folder):
    """The elements of a pack's description (open-cmsis-pack.github.io, "Pack Description (*.pdsc) Format"): the
    grammar pdsc.rng, which xmllint checks, and the files that it names."""
    import xml.etree.ElementTree as tree

    library = folder / "microtin"
    faults = common(library)
    [path] = library.glob("*.pdsc")
    lint = subprocess.run(
        ["xmllint", "--noout", "--relaxng", str(HERE / "pdsc.rng"), str(path)], capture_output=True, text=True
    )
    faults.unless(lint.returncode == 0, lint.stderr.strip())
    if lint.returncode != 0:
        return faults
    root = tree.parse(path).getroot()
    faults.unless(path.name == f"{root.findtext('vendor')}.{root.findtext('name')}.pdsc", "the file has another name")
    versions = [root.find("releases/release").get("version"), *(c.get("Cversion") for c in root.iter("component"))]
    faults.unless(set(versions) == {stamp(library)}, "a version is not the header's")
    conditions = {condition.get("id") for condition in root.iter("condition")}
    used = {c.get("condition") for c in root.iter("component")} - {None}
    faults.unless(used <= conditions, "a component has a condition that is not there")
    faults.files(library, [root.findtext("license"), *(file.get("name") for file in root.iter("file"))])
    return faults


def meson(folder):
    """The keys of a wrap (mesonbuild.com, "Wrap dependency system manual"); Meson itself reads the rest."""
    import configparser

    library = folder / "microtin"
    faults = common(library)
    wrap = configparser.ConfigParser()
    wrap.read(folder / "microtin.wrap")
    faults.unless("wrap-file" in wrap, "the wrap is of no file")
    faults.files(folder, [wrap.get("wrap-file", "directory", fallback="none")])
    script = (library / "meson.build").read_text()
    variables = [name.strip() for name in wrap.get("provide", "microtin", fallback="none").split(",")]
    faults.unless(all(f"{name} = declare_dependency" in script for name in variables), "the wrap provides what is not")
    faults.unless(f"version: '{stamp(library)}'" in script, "the version is not the header's")
    return faults


KINDS = {"arduino": arduino, "platformio": platformio, "esp-idf": esp_idf, "zephyr": zephyr, "cmsis-pack": cmsis_pack,
         "meson": meson}  # fmt: skip

if __name__ == "__main__":
    try:
        found = KINDS[sys.argv[1]](Path(sys.argv[2]))
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(77)
    except FileNotFoundError as error:
        found = [str(error)]
        if error.filename == "xmllint":
            print("skipped: xmllint is not installed")
            sys.exit(77)
    for fault in found:
        print(f"rejected: {fault}")
    print(f"{sys.argv[1]}: {len(found)} faults")
    sys.exit(1 if found else 0)
