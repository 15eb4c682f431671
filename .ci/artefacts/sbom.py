# SPDX-License-Identifier: MIT
"""sbom.py VERSION FOLDER: prints the bill of materials of the artefacts in FOLDER: SPDX 2.3, JSON. The versions of other
projects are those of the headers that the compilers here find."""

import datetime
import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from refusals import git, project_url  # noqa: E402

HOST, WINDOWS = "g++", "x86_64-w64-mingw32-g++-posix"
GPL_EXCEPT = "GPL-3.0-or-later WITH GCC-exception-3.1"
LINKED, TESTED = "STATIC_LINK", "TEST_DEPENDENCY_OF"
# Name, compiler, header, macros of the version ("": another way), licence, address, how microtin uses the project.
PARTS = (
    ("CLI11", HOST, "CLI/Version.hpp", ["CLI11_VERSION"], "BSD-3-Clause", "https://github.com/CLIUtils/CLI11", LINKED),
    ("stb_image_write", HOST, "stb/stb_image_write.h", [], "MIT OR Unlicense", "https://github.com/nothings/stb", LINKED),
    ("zlib", HOST, "zlib.h", ["ZLIB_VERSION"], "Zlib", "https://zlib.net", LINKED),
    ("glibc", HOST, "features.h", ["__GLIBC__", "__GLIBC_MINOR__"], "LGPL-2.1-or-later",
     "https://www.gnu.org/software/libc/", LINKED),
    ("libstdc++", HOST, "", ["__GNUC__", "__GNUC_MINOR__", "__GNUC_PATCHLEVEL__"], GPL_EXCEPT, "https://gcc.gnu.org", LINKED),
    ("nlohmann-json", HOST, "nlohmann/json.hpp",
     [f"NLOHMANN_JSON_VERSION_{part}" for part in ("MAJOR", "MINOR", "PATCH")], "MIT", "https://github.com/nlohmann/json", TESTED),
    ("zlib-windows", WINDOWS, "zlib.h", ["ZLIB_VERSION"], "Zlib", "https://zlib.net", LINKED),
    ("libstdc++-windows", WINDOWS, "", ["__GNUC__", "__GNUC_MINOR__", "__GNUC_PATCHLEVEL__"], GPL_EXCEPT,
     "https://gcc.gnu.org", LINKED),
    ("mingw-w64", WINDOWS, "_mingw.h", [f"__MINGW64_VERSION_{part}" for part in ("MAJOR", "MINOR", "BUGFIX")], "ZPL-2.1",
     "https://www.mingw-w64.org", LINKED),
)  # fmt: skip


def preprocessed(compiler, header, *options):
    text = f"#include <{header}>\n" if header else "\n"
    run = subprocess.run([compiler, "-x", "c++", "-E", *options, "-"], input=text, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{header}: not found by {compiler}; install the packages of .ci/packages/tool and .ci/packages/release")
    return run.stdout


def version_of(compiler, header, macros):
    if not macros:  # stb states its version in its first line
        path = re.search(rf'^# 1 "(/[^"]*{re.escape(header)})"', preprocessed(compiler, header), re.M).group(1)
        return re.search(r"v(\d+\.\d+)", Path(path).read_text().split("\n")[0]).group(1)
    defined = dict(re.findall(r"^#define (\w+) (.*)$", preprocessed(compiler, header, "-dM"), re.M))
    return ".".join(defined[macro].strip('"') for macro in macros)


def checksums(content):
    return [{"algorithm": name.upper(), "checksumValue": hashlib.new(name, content).hexdigest()} for name in ("sha1", "sha256")]


def file_entry(path):
    return {
        "SPDXID": "SPDXRef-File-" + re.sub(r"[^A-Za-z0-9.-]", "-", path.name),
        "fileName": f"./{path.name}",
        "checksums": checksums(path.read_bytes()),
        "fileTypes": ["DOCUMENTATION" if path.suffix == ".md" else "ARCHIVE"],
        "licenseConcluded": "NOASSERTION",
        "licenseInfoInFiles": ["NOASSERTION"],
        "copyrightText": "NOASSERTION",
    }


def verification_code(files):
    """As SPDX 2.3, 7.9 defines it: the SHA1 of the sorted SHA1s of the files."""
    return hashlib.sha1("".join(sorted(file["checksums"][0]["checksumValue"] for file in files)).encode()).hexdigest()


def own_package(version, files):
    return {
        "SPDXID": "SPDXRef-Package-microtin",
        "name": "microtin",
        "versionInfo": version,
        "supplier": "Organization: The microtin authors",
        "downloadLocation": project_url(),
        "homepage": project_url(),
        "filesAnalyzed": True,
        "packageVerificationCode": {"packageVerificationCodeValue": verification_code(files)},
        "licenseConcluded": "MIT",
        "licenseInfoFromFiles": ["NOASSERTION"],
        "licenseDeclared": "MIT",
        "copyrightText": re.search(r"Copyright .*", Path("LICENSE").read_text()).group(0),
        "hasFiles": [file["SPDXID"] for file in files],
    }


def other_package(name, compiler, header, macros, licence, address, _):
    return {
        "SPDXID": f"SPDXRef-Package-{name.replace('+', 'x').replace('_', '-')}",
        "name": name.removesuffix("-windows"),
        "versionInfo": version_of(compiler, header, macros),
        "downloadLocation": address,
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",
        "licenseDeclared": licence,
        "copyrightText": "NOASSERTION",
    }


def document(version, folder):
    names = sorted(path.name for path in folder.iterdir() if path.is_file())
    files = [file_entry(folder / name) for name in names]
    used = [part for part in PARTS if part[1] == HOST or any("windows" in name for name in names)]
    own, others = own_package(version, files), [other_package(*part) for part in used]
    made = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", own["SPDXID"])]
    relations += [(own["SPDXID"], "CONTAINS", file["SPDXID"]) for file in files]
    for package, part in zip(others, used):
        ends = (own["SPDXID"], package["SPDXID"])
        relations.append((ends[0], LINKED, ends[1]) if part[6] == LINKED else (ends[1], TESTED, ends[0]))
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"microtin-{version}",
        "documentNamespace": f"{project_url()}/spdx/microtin-{version}-{git('rev-parse', 'HEAD').strip()}",
        "creationInfo": {"created": made.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: microtin-.ci-release"]},
        "documentDescribes": [own["SPDXID"]],
        "packages": [own, *others],
        "files": files,
        "relationships": [
            {"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other} for one, kind, other in relations
        ],
    }


def main():
    print(json.dumps(document(sys.argv[1], Path(sys.argv[2])), indent=1))


if __name__ == "__main__":
    main()
