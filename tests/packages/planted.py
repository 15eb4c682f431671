# SPDX-License-Identifier: MIT
"""planted.py FOLDER: breaks each package in several ways, one at a time, and fails unless the rules find it."""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Package, file, what is replaced by what (None: the file goes), and what must be said.
FAULTS = [
    ("arduino", "library.properties", "category=Data Processing", "category=Terrain", "no such category"),
    ("arduino", "library.properties", "version=", "version=1.", "version is not x.y.z"),
    ("arduino", "library.properties", "includes=microtin.h", "includes=terrain.h", "terrain.h is not there"),
    ("arduino", "library.properties", "author=", "Author=", "author is missing"),
    ("arduino", "library.properties", "architectures=avr", "architectures=*", "no board that fits: *"),
    ("arduino", "library.properties", "esp8266,", "", "boards that fit are not named: esp8266"),
    ("arduino", "src/board.cpp", "0xBFFF", "0x7FFF", "the limit of flash is wrong for Arduino Uno R3"),
    ("arduino", "src/board.cpp", "0xBFFF", "0x8FFF", "do not fit the least flash"),
    ("arduino", "examples/Height/Height.ino", None, None, "Height/Height.ino is not there"),
    ("arduino", "LICENSE", None, None, "LICENSE is not there"),
    ("platformio", "library.json", '"version": "', '"version": "9', "version is not the header's"),
    ("platformio", "library.json", '"includeDir": "src"', '"includeDir": "include"', "include is not there"),
    ("platformio", "library.json", '"microtin/pack.h",', "", "headers that are not named"),
    ("platformio", "library.json", '"terrain"', '"Terrain"', "a keyword is not small"),
    ("platformio", "library.json", '"atmelavr"', '"ststm8"', "no board that fits: ststm8"),
    ("platformio", "library.json", '"license"', '"licence"', "unknown fields"),
    ("esp-idf", "idf_component.yml", ">=4.4", "new", "no range of versions"),
    ("esp-idf", "CMakeLists.txt", "if(ESP_PLATFORM)", "if(IDF)", "IDF is asked behind project()"),
    ("esp-idf", "idf_component.yml", "licen", "Licen", "unknown fields"),
    ("zephyr", "zephyr/module.yml", "kconfig: zephyr/Kconfig", "kconfig: Kconfig", "Kconfig is not there"),
    ("zephyr", "zephyr/module.yml", "  cmake:", "  make:", "unknown keys of build"),
    ("cmsis-pack", "microtin.microtin.pdsc", "<vendor>microtin</vendor>", "", "fails to validate"),
    ("cmsis-pack", "microtin.microtin.pdsc", "<name>microtin<", "<name>tin<", "the file has another name"),
    ("cmsis-pack", "microtin.microtin.pdsc", 'name="src/microtin.h"', 'name="microtin.h"', "microtin.h is not there"),
    ("cmsis-pack", "microtin.microtin.pdsc", 'condition="', 'condition="No ', "a condition that is not there"),
    ("cmsis-pack", "microtin.microtin.pdsc", 'category="header"', 'category="head"', "fails to validate"),
    ("meson", "meson.build", "microtin_dep =", "dep =", "provides what is not"),
    ("meson", "src/microtin/microtin.h", "MICROTIN_VERSION_PATCH 0", "MICROTIN_VERSION_PATCH 9", "another version"),
]


def found(kind, name, old, new, wanted, packages):
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(packages / kind, folder, dirs_exist_ok=True)
        path = Path(folder) / "microtin" / name
        if old is None:
            path.unlink()
        else:
            text = path.read_text()
            assert old in text, f"{name} has no {old}"
            path.write_text(text.replace(old, new))
        rules = [sys.executable, str(Path(__file__).parent / "rules.py"), kind, folder]
        run = subprocess.run(rules, capture_output=True, text=True)
        said = run.stdout + run.stderr
        return run.returncode == 77 or (run.returncode == 1 and "rejected: " in said and wanted in said)


missed = [fault for fault in FAULTS if not found(*fault, Path(sys.argv[1]))]
for fault in missed:
    print("missed:", *fault)
print(f"{len(FAULTS) - len(missed)} of {len(FAULTS)} found")
sys.exit(1 if missed else 0)
