# SPDX-License-Identifier: MIT
"""configure.py PACKAGE BUILD NAME=VALUE...: what Zephyr's own scripts make of the module, from the checkout $ZEPHYR_BASE.
zephyr_module.py reads module.yml by its schema, and kconfiglib reads the configuration of all of Zephyr with that of the
module. Then symbols get values, and BUILD/config.cmake has CONFIG_... as CMake reads them."""

import os
import re
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
BASE, PACKAGE, BUILD = Path(os.environ["ZEPHYR_BASE"]), Path(sys.argv[1]), Path(sys.argv[2])
STANDARDS = {"STD_CPP11": 11, "STD_CPP14": 14, "STD_CPP17": 17, "STD_CPP20": 20}
MOST_GENERATED = 50  # files

sys.path.insert(0, str(BASE / "scripts/kconfig"))
import kconfiglib  # noqa: E402


def unless(condition, text):
    if not condition:
        sys.exit("rejected: " + text)


def add_module():
    """Writes what zephyr_module.py finds of the module, as Zephyr's CMake code calls it."""
    command = [sys.executable, BASE / "scripts/zephyr_module.py", "--zephyr-base", BASE, "--modules", PACKAGE]
    command += ["--kconfig-out", BUILD / "Kconfig.modules", "--cmake-out", BUILD / "modules.txt"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    unless(f"{PACKAGE}/zephyr/Kconfig" in (BUILD / "Kconfig.modules").read_text(), "Kconfig is not among the modules'")
    unless(f'"microtin":"{PACKAGE}":"{PACKAGE}/zephyr"' in (BUILD / "modules.txt").read_text(), "the module is not named")


def configuration():
    """All of Zephyr's symbols, for all boards, as its own documentation is made. Files that a build would generate are
    empty."""
    os.environ.update(srctree=str(BASE), KCONFIG_DOC_MODE="1", KCONFIG_BINARY_DIR=str(BUILD), ARCH="*", ARCH_DIR="arch",
                      SOC_DIR="soc", BOARD_DIR="boards/*/*", TOOLCHAIN_KCONFIG_DIR=str(BUILD),
                      APPLICATION_SOURCE_DIR=str(BUILD))  # fmt: skip
    for _ in range(MOST_GENERATED):
        try:
            return kconfiglib.Kconfig("Kconfig", warn_to_stderr=False)
        except kconfiglib.KconfigError as error:
            missing = re.search(r"'(\S+)' not found", str(error))
            if missing is None or not Path(missing[1]).is_relative_to(BUILD):
                raise
            Path(missing[1]).parent.mkdir(parents=True, exist_ok=True)
            Path(missing[1]).write_text("")
    sys.exit("rejected: more files are missing than a build generates")


def chosen(config):
    """Sets what the command line has, and returns the C++ standard. C++ itself and C++11 are needed."""
    symbols = config.syms
    cpp = "CPP" if "CPP" in symbols and symbols["CPP"].nodes else "CPLUSPLUS"
    module = symbols["MICROTIN"]
    module.set_value("y")
    unless(module.str_value == "n", "MICROTIN does not need C++")
    symbols[cpp].set_value("y")
    symbols["STD_CPP98"].set_value("y")
    unless(module.str_value == "n", "C++98 is enough")
    symbols["STD_CPP11"].set_value("y")
    unless(module.str_value == "y", f"{cpp} and STD_CPP11 do not suffice")
    for choice in sys.argv[3:]:
        name, value = choice.split("=")
        symbols[name].set_value(value)
        unless(symbols[name].str_value == value, f"{name} is not {value}")
    return cpp, next(standard for name, standard in STANDARDS.items() if symbols[name].str_value == "y")


add_module()
config = configuration()
cpp, standard = chosen(config)
warnings = [warning for warning in config.warnings if "microtin" in warning.lower()]
unless(not warnings, "; ".join(warnings))
lines = [f"set(CONFIG_{s.name} {s.str_value})\n" for s in config.unique_defined_syms
         if s.name.startswith("MICROTIN") and s.str_value == "y"]  # fmt: skip
(BUILD / "config.cmake").write_text("".join(lines) + f"set(STANDARD {standard})\n")
print(f"{len(config.unique_defined_syms)} symbols of Zephyr; {cpp} chooses the module, C++{standard}: " + " ".join(sys.argv[3:]))
