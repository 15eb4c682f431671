# SPDX-License-Identifier: MIT
"""check.py VERSION FOLDER: checks finished artefacts: each file has its checksum in SHA256SUMS, the bill of materials has
the fields that SPDX 2.3 requires and the checksum of each file, and each package states VERSION."""

import hashlib
import json
import re
import sys
import tarfile
import zipfile
from pathlib import Path

# What SPDX 2.3 requires of a document, its packages, its files and its relationships (clauses 6 to 11).
DOCUMENT = ("spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo", "packages", "files",
            "relationships")  # fmt: skip
PACKAGE = ("SPDXID", "name", "downloadLocation", "versionInfo", "licenseConcluded", "licenseDeclared", "copyrightText")
FILE = ("SPDXID", "fileName", "checksums", "licenseConcluded", "licenseInfoInFiles", "copyrightText")
RELATIONSHIP = ("spdxElementId", "relationshipType", "relatedSpdxElement")
# Where an archive states its version: the end of its name, the end of the member's name, the statement.
STATEMENTS = (
    ("-source.tar.gz", "include/microtin/microtin.h", None),
    ("-linux-x86_64.tar.gz", "share/man/man1/microtin.1", r'^\.TH .*"?microtin {version}\b'),
    (".whl", ".dist-info/METADATA", r"^Version: {version}$"),
    (".tgz", "package/package.json", r'"version": "{version}"'),
    ("-arduino.zip", "library.properties", r"^version={version}$"),
    ("-platformio.tar.gz", "library.json", r'"version": "{version}"'),
    ("-esp-idf.zip", "idf_component.yml", r'^version: "{version}"$'),
    ("-zephyr.zip", "src/microtin/microtin.h", None),
    ("-meson.zip", "meson.build", r"version: '{version}'"),
    (".pack", ".pdsc", r'<release version="{version}">'),
    (".tar.gz", "/PKG-INFO", r"^Version: {version}$"),
)  # fmt: skip


def sums(folder):
    """SHA256SUMS names each other file of the folder once, with its checksum."""
    lines = (folder / "SHA256SUMS").read_text().splitlines()
    stated = dict(reversed(line.split("  ", 1)) for line in lines)
    there = {path.name for path in folder.iterdir()} - {"SHA256SUMS"}
    if len(stated) != len(lines) or set(stated) != there:
        yield f"SHA256SUMS: does not name each file once: {', '.join(sorted(set(stated) ^ there))}"
    for name in sorted(there & set(stated)):
        if hashlib.sha256((folder / name).read_bytes()).hexdigest() != stated[name]:
            yield f"{name}: has another checksum than in SHA256SUMS"


def missing(kind, entries, fields):
    for entry in entries:
        for field in fields:
            if not entry.get(field):
                yield f"{kind} {entry.get('SPDXID', '')}: has no {field}"


def checksum_faults(folder, files):
    for file in files:
        path = folder / file.get("fileName", "")
        stated = {entry["algorithm"]: entry["checksumValue"] for entry in file.get("checksums", ())}
        if set(stated) != {"SHA1", "SHA256"} or not path.is_file():
            yield f"{file.get('fileName')}: is not there, or has no SHA1 and SHA256 in the bill of materials"
            continue
        for kind, value in stated.items():
            if hashlib.new(kind.lower(), path.read_bytes()).hexdigest() != value:
                yield f"{path.name}: has another {kind} than in the bill of materials"


def structure(bill):
    """Identifiers are unique and known, and the document describes a package."""
    elements = [bill, *bill["packages"], *bill["files"]]
    names = [element.get("SPDXID", "") for element in elements]
    yield from (f"SPDXID {name!r}: is not unique, or not an identifier" for name in sorted(set(names))
                if names.count(name) > 1 or not re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", name))  # fmt: skip
    ends = {relation[end] for relation in bill["relationships"] for end in (RELATIONSHIP[0], RELATIONSHIP[2])}
    yield from (f"a relationship names {name}, which is not there" for name in sorted(ends - set(names)))
    if not any(r["relationshipType"] == "DESCRIBES" and r["spdxElementId"] == bill["SPDXID"] for r in bill["relationships"]):
        yield "the bill of materials describes no package"
    if not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", bill["creationInfo"].get("created", "")):
        yield "creationInfo: created is not a date and time in UTC"
    if not bill["creationInfo"].get("creators"):
        yield "creationInfo: has no creators"


def verification(bill):
    for package in bill["packages"]:
        if package.get("filesAnalyzed", True):
            sha1s = sorted(c["checksumValue"] for f in bill["files"] for c in f["checksums"] if c["algorithm"] == "SHA1")
            code = hashlib.sha1("".join(sha1s).encode()).hexdigest()
            if package.get("packageVerificationCode", {}).get("packageVerificationCodeValue") != code:
                yield f"{package['SPDXID']}: its verification code is not that of its files"


def bill_of_materials(version, folder):
    path = folder / f"microtin-{version}.spdx.json"
    bill = json.loads(path.read_text())
    found = list(missing("document", [bill], DOCUMENT))
    if found:
        return found
    if (bill["spdxVersion"], bill["dataLicense"]) != ("SPDX-2.3", "CC0-1.0"):
        found.append(f"{path.name}: is not SPDX 2.3 under CC0-1.0")
    if bill["packages"][0].get("versionInfo") != version:
        found.append(f"{path.name}: the package's version is not {version}")
    listed = {file.get("fileName", "").removeprefix("./") for file in bill["files"]}
    there = {entry.name for entry in folder.iterdir()} - {"SHA256SUMS", path.name}
    if listed != there:
        found.append(f"{path.name}: does not list each file: {', '.join(sorted(listed ^ there))}")
    found += missing("package", bill["packages"], PACKAGE)
    found += missing("file", bill["files"], FILE)
    found += missing("relationship", bill["relationships"], RELATIONSHIP)
    if not found:
        found += [*structure(bill), *verification(bill)]
    return found + list(checksum_faults(folder, bill["files"]))


def member(archive, end):
    """The text of the first member, by depth, whose name ends so."""
    if zipfile.is_zipfile(archive):
        with zipfile.ZipFile(archive) as opened:
            names = sorted((name for name in opened.namelist() if name.endswith(end)), key=lambda name: name.count("/"))
            return opened.read(names[0]).decode() if names else ""
    with tarfile.open(archive) as opened:
        names = sorted((name for name in opened.getnames() if name.endswith(end)), key=lambda name: name.count("/"))
        return opened.extractfile(names[0]).read().decode() if names else ""


def stated_versions(version, folder):
    for path in sorted(folder.iterdir()):
        for end, name, statement in STATEMENTS:
            if path.name.endswith(end):
                text = member(path, name)
                if statement is None:
                    stated = ".".join(re.findall(r"define MICROTIN_VERSION_[A-Z]+ (\d+)", text)) == version
                else:
                    stated = re.search(statement.replace("{version}", re.escape(version)), text, re.M)
                if not stated:
                    yield f"{path.name}: {name} in it does not state version {version}"
                break


def main():
    version, folder = sys.argv[1], Path(sys.argv[2])
    found = [*sums(folder), *bill_of_materials(version, folder), *stated_versions(version, folder)]
    for fault in found:
        print("rejected:", fault, file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
