# SPDX-License-Identifier: MIT
"""refusals.py [--trial] VERSION: prints why the sources here are not ready to be released as VERSION, one reason a line:
place, fault and remedy. Fails if there is a reason. With --trial, reasons that only a declared release must not have
are printed as warnings."""

import datetime
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "fuzz"))
from hours import hours  # noqa: E402

CONTROL = ".ci/debian/control"
HEADER = "decoder/include/microtin/microtin.h"
# Files in which ecosystems look for a version. A version written there must be the header's.
MANIFESTS = re.compile(
    r"(^|/)(CMakeLists\.txt|pyproject\.toml|setup\.(py|cfg)|CITATION\.cff|package\.json|library\.(json|properties)|codemeta\.json"
    r"|idf_component\.yml|module\.yml|meson\.build|vcpkg\.json|conanfile\.py|Doxyfile|[^/]+\.(pdsc|wrap))$"
)
STATED = re.compile(r"(?<![-\w])(?:PROJECT_NUMBER|version|VERSION)[\"']?\s*[:=]?\s*[\"']?(\d+\.\d+\.\d+)\b")
# Each format: its page, the source of its version, the constant there.
FORMATS = (
    ("shared/docs/format-stream.md", "shared/format.hpp", "kVersion"),
    ("shared/docs/format-pack.md", "shared/pack_format.hpp", "kPackVersion"),
)
ONLY_RELEASES = ("tree", "changelog", "frozen", "fuzzed", "address")  # what --trial only warns of
# Hours of processor time that fuzzing must have taken, in all and since the decoder's sources changed.
FUZZED_HOURS, FUZZED_SINCE_CHANGE = 24, 4


def git(*arguments):
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def tree(version):
    changed = git("status", "--porcelain").splitlines()
    if changed:
        names = ", ".join(line[3:] for line in changed[:5])
        yield f"{len(changed)} files differ from the last commit ({names}); commit or remove them"


def header_version(root=Path(".")):
    numbers = re.findall(r"define MICROTIN_VERSION_[A-Z]+ (\d+)", (root / HEADER).read_text())
    return ".".join(numbers)


def versions(version):
    stated = header_version()
    if stated != version:
        yield f"{HEADER}: the library's version is {stated}, not {version}; change MICROTIN_VERSION_* or release {stated}"
    for name in git("ls-files").splitlines():
        if MANIFESTS.search(name) and not name.startswith(("tests/", "fuzz/")):
            for number, line in enumerate(Path(name).read_text().splitlines(), 1):
                for other in STATED.findall(line):
                    if other != version:
                        yield f"{name}:{number}: states version {other}, not {version}; take the version from {HEADER}"


def section(text, name):
    """The lines of CHANGELOG.md below the heading "## name" or "## name - date", and that date (None without)."""
    found = re.search(rf"^## {re.escape(name)}(?: - (\S+))?\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    return found and (found.group(2).strip("\n") + "\n", found.group(1))


def is_date(text):
    try:
        return bool(text) and datetime.date.fromisoformat(text) is not None
    except ValueError:
        return False


def changelog(version):
    found = section(Path("CHANGELOG.md").read_text(), version)
    if not found:
        yield f'CHANGELOG.md: has no section of {version}; rename "## Unreleased" to "## {version} - YYYY-MM-DD"'
    elif not is_date(found[1]):
        yield f'CHANGELOG.md: the section of {version} has no date; write "## {version} - YYYY-MM-DD"'
    elif not found[0].strip():
        yield f"CHANGELOG.md: the section of {version} is empty; write what users must know"


def format_versions(version):
    for page, source, constant in FORMATS:
        title = re.match(r"# The microtin \w+, version (\d+)\n", Path(page).read_text())
        number = re.search(rf"\b{constant} = (\d+);", Path(source).read_text())
        if not title or not number or title.group(1) != number.group(1):
            yield f"{page}:1: does not have the version of {source} ({constant}) in its title; correct one of them"


def frozen(version):
    for page, _, _ in FORMATS:
        status = re.search(r"^Status: (.*)$", Path(page).read_text(), re.M)
        if not status or not re.match(r"frozen since \d+\.\d+\.\d+\b", status.group(1)):
            state = status.group(1).split(".")[0] if status else "missing"
            yield f'{page}: the status of the format is "{state}"; freeze it, and write "Status: frozen since {version}."'
    for number, line in enumerate(Path("README.md").read_text().splitlines(), 1):
        if "not frozen" in line:
            yield f"README.md:{number}: states that the format is not frozen; freeze it, and remove the sentence"


def fuzzed(version):
    in_all, since_change = hours()
    if in_all < FUZZED_HOURS or since_change < FUZZED_SINCE_CHANGE:
        yield (
            f"fuzz/log.txt: has {in_all:.1f} hours of fuzzing, {since_change:.1f} with the decoder as it is, not {FUZZED_HOURS} and"
            f" {FUZZED_SINCE_CHANGE}; run fuzz/run, then python3 fuzz/hours.py --record"
        )


def project_url(root=Path(".")):
    return re.search(r'HOMEPAGE_URL "([^"]+)"', (root / "CMakeLists.txt").read_text()).group(1)


def address(version):
    if ".example" in project_url():
        yield f"CMakeLists.txt: HOMEPAGE_URL is a placeholder, {project_url()}; write the project's address"
    if not re.match(r"https://[^/]+/[^?#]*[^/?#]$", project_url()):
        yield f"CMakeLists.txt: HOMEPAGE_URL, {project_url()}, is not a repository's; write https://HOST/PATH"
    if "@example." in Path(CONTROL).read_text():
        yield f"{CONTROL}: the address of the Maintainer is a placeholder; write one that people can reach"


CHECKS = (tree, versions, changelog, format_versions, frozen, fuzzed, address)


def main():
    trial, version = "--trial" in sys.argv[1:-1], sys.argv[-1]
    refused = False
    for check in CHECKS:
        warns = trial and check.__name__ in ONLY_RELEASES
        for reason in check(version):
            print(f"{'warning' if warns else 'refused'}: {reason}", file=sys.stderr)
            refused |= not warns
    sys.exit(1 if refused else 0)


if __name__ == "__main__":
    main()
