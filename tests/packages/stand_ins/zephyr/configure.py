# SPDX-License-Identifier: MIT
"""configure.py KCONFIG CMAKE NAME=VALUE...: sets symbols of a module's Kconfig below that of Zephyr's stand-in, and
writes CONFIG_... as CMake reads them."""

import os
import sys
from pathlib import Path

import kconfiglib

os.environ["MODULE_KCONFIG"] = sys.argv[1]
zephyr = Path(__file__).parent / "Kconfig"
config = kconfiglib.Kconfig(str(zephyr), warn_to_stderr=False)
for choice in sys.argv[3:]:
    name, value = choice.split("=")
    config.syms[name].set_value(value)
    if config.syms[name].str_value != value:
        sys.exit(f"rejected: {name} is not {value}")
if config.warnings:
    sys.exit("rejected: " + "; ".join(config.warnings))
lines = [f"set(CONFIG_{s.name} {s.str_value})\n" for s in config.unique_defined_syms if s.str_value == "y"]
Path(sys.argv[2]).write_text("".join(lines))

older = Path(sys.argv[2]).with_suffix(".older")
older.write_text(zephyr.read_text().replace("config CPP\n", "config CPLUSPLUS\n"))
symbols = kconfiglib.Kconfig(str(older), warn_to_stderr=False).syms
symbols["MICROTIN"].set_value("y")
if symbols["MICROTIN"].str_value != "y":
    sys.exit("rejected: MICROTIN is not there where C++ is CPLUSPLUS")

# What the module needs of C++ is asked for.
config.syms["STD_CPP98"].set_value("y")
if config.syms["MICROTIN"].str_value != "n":
    sys.exit("rejected: C++98 is enough")
