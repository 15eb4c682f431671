# SPDX-License-Identifier: MIT
"""Puts the shared library into the package: that of the environment's MICROTIN_LIBRARY, or one built of the sources
next to this file, which takes CMake, a C++ compiler and the packages of the tool. If the environment has
MICROTIN_SYSTEM_LIBRARY, the package contains no library, and loads the one that another package installed."""

import os
import re
import shutil
import subprocess
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # setuptools before 70.1
    from wheel.bdist_wheel import bdist_wheel

SOURCES = Path(__file__).resolve().parent
BUILD = SOURCES / "build" / "python-package"  # so that nothing is built among the sources
USES_SYSTEM_LIBRARY = bool(os.environ.get("MICROTIN_SYSTEM_LIBRARY"))


def version():
    header = (SOURCES / "decoder/include/microtin/microtin.h").read_text()
    return ".".join(re.findall(r"define MICROTIN_VERSION_[A-Z]+ (\d+)", header))


def project_url():
    return re.search(r'HOMEPAGE_URL "([^"]+)"', (SOURCES / "CMakeLists.txt").read_text()).group(1)


def long_description():
    """The page of the documents; its links lead to the project's other pages, of this version."""
    page = (SOURCES / "encoder/docs/python.md").read_text()
    return re.sub(r"\]\((?!https?:)", f"]({project_url()}/blob/v{version()}/encoder/docs/", page)


def built_library(folder):
    # The packages of the tool have Ninja, and CMake asks for make.
    generator = ["-G", "Ninja"] if shutil.which("ninja") and "CMAKE_GENERATOR" not in os.environ else []
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DMICROTIN_TESTS=OFF"]
    subprocess.check_call(["cmake", "-S", SOURCES, "-B", folder, *generator, *options])
    subprocess.check_call(["cmake", "--build", folder, "--parallel", str(os.cpu_count() or 1), "--target", "microtin_shared"])
    return Path(folder) / "libmicrotin.so"


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        temporary = self.get_finalized_command("build").build_temp
        library = os.environ.get("MICROTIN_LIBRARY") or built_library(temporary)
        shutil.copy(library, Path(self.build_lib) / "microtin" / "libmicrotin.so")


class WheelOfThePlatform(bdist_wheel):
    """Any Python, but one kind of machine: the library is called by ctypes."""

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


class Binary(Distribution):
    """Installed where packages with machine code are, as its wheel says."""

    def has_ext_modules(self):
        return True


BUILD.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    project_urls={"Homepage": project_url()},
    long_description=long_description(),
    long_description_content_type="text/markdown",
    distclass=Distribution if USES_SYSTEM_LIBRARY else Binary,
    cmdclass={} if USES_SYSTEM_LIBRARY else {"build_py": BuildWithLibrary, "bdist_wheel": WheelOfThePlatform},
    options={"build": {"build_base": str(BUILD)}, "egg_info": {"egg_base": str(BUILD)}},
)
