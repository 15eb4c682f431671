# SPDX-License-Identifier: MIT
"""release_test.py: .ci/release refuses sources that are not ready, each for its reason, and its parts do what they must:
archives depend on names, bytes and permissions alone, notes come from the change log, and the check of finished files
finds each planted fault."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ARTEFACTS = ROOT / ".ci/artefacts"
VERSION = "7.8.9"
CONTROL = ".ci/debian/control"
HEADER = "decoder/include/microtin/microtin.h"
STREAM, PACK = "shared/docs/format-stream.md", "shared/docs/format-pack.md"
COPIED = (".ci/release", ".ci/artefacts", "CMakeLists.txt", "CHANGELOG.md", "CITATION.cff", "LICENSE", "README.md",
          "decoder/packages", "pyproject.toml", "setup.py", STREAM, PACK, "shared/format.hpp", "shared/pack_format.hpp",
          HEADER, CONTROL, "fuzz/hours.py")  # fmt: skip
GIT = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"} | {
    f"GIT_{who}_{what}": "test@microtin.example" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
}
EPOCH = {"SOURCE_DATE_EPOCH": "1700000000"}


def run(*command, folder, **environment):
    return subprocess.run([str(part) for part in command], cwd=folder, env={**os.environ, **GIT, **environment},
                          capture_output=True, text=True)  # fmt: skip


def replace(path, old, new):
    text = path.read_text()
    assert old in text, f"{path} does not have {old!r}"
    path.write_text(text.replace(old, new))


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)


def ready(folder):
    """A repository that may be released as VERSION: the sources here, with what is missing."""
    for name in COPIED:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if (ROOT / name).is_dir() else shutil.copy)(ROOT / name, folder / name)
    text = (folder / HEADER).read_text()
    for part, number in zip(("MAJOR", "MINOR", "PATCH"), VERSION.split(".")):
        line = next(line for line in text.splitlines() if f"define MICROTIN_VERSION_{part} " in line)
        text = text.replace(line, f"#define MICROTIN_VERSION_{part} {number}")
    (folder / HEADER).write_text(text)
    changes = (folder / "CHANGELOG.md").read_text()
    (folder / "CHANGELOG.md").write_text(
        changes.partition("\n## ")[0] + f"\n## {VERSION} - 2026-12-01\n\n### Added\n\n- A line.\n\n## 1.0.0 - 2025-01-01\n\n- Old.\n"
    )
    script = (folder / "CMakeLists.txt").read_text()
    (folder / "CMakeLists.txt").write_text(script.replace("microtin.example", "microtin.test"))
    replace(folder / CONTROL, "microtin@example.org", "microtin@microtin.test")
    log(folder, 25, 5)
    (folder / ".gitignore").write_text("build/\n")
    run("git", "init", "-q", folder=folder)
    commit(folder)


def log(folder, in_all, since_change):
    """Writes hours of fuzzing: in all, and with the decoder as it is."""
    sources = run(sys.executable, "fuzz/hours.py", "--sources", folder=folder).stdout.strip()
    rows = (("0" * 12, in_all - since_change), (sources, since_change))
    text = "".join(f"2026-12-01 {digest} decode 1000 {3600 * hours:.0f}\n" for digest, hours in rows)
    (folder / "fuzz/log.txt").write_text("# comment\n" + text)


def commit(folder):
    run("git", "add", "-A", folder=folder)
    run("git", "commit", "-q", "-m", "all", folder=folder)


class Refusals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ready = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.ready)
        ready(cls.ready)

    def refused(self, plant, *reasons, committed=True, trial=True):
        """The planted faults are the only reasons, and in a trial, if they may be, warnings."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "tree"
            shutil.copytree(self.ready, folder)
            plant(folder)
            if committed:
                commit(folder)
            for arguments, word in ([], "refused"), (["--trial"], "warning" if trial else "refused"):
                release = run(".ci/release", *arguments, "--check", VERSION, folder=folder)
                lines = release.stderr.splitlines()
                self.assertEqual((release.returncode, len(lines)), (int(word == "refused"), len(reasons)), release.stderr)
                for line, reason in zip(lines, reasons):
                    self.assertRegex(line, f"^{word}: .*{reason}")

    def test_ready_sources_pass(self):
        release = run(".ci/release", "--check", VERSION, folder=self.ready)
        self.assertEqual((release.returncode, release.stderr), (0, ""))

    def test_a_changed_tree(self):
        self.refused(lambda folder: replace(folder / "README.md", "# microtin", "# Microtin"),
                     r"1 files differ from the last commit \(README.md\); commit", committed=False)  # fmt: skip

    def test_a_file_that_git_does_not_have(self):
        self.refused(lambda folder: (folder / "new.txt").write_text(""), r"\(new.txt\); commit", committed=False)

    def test_a_version_that_the_header_does_not_have(self):
        def plant(folder):
            replace(folder / HEADER, "VERSION_PATCH 9", "VERSION_PATCH 8")

        self.refused(plant, "microtin.h: the library's version is 7.8.8, not 7.8.9; change", trial=False)

    def test_a_version_in_a_manifest(self):
        places = {
            "CITATION.cff": ("title: microtin", "title: microtin\nversion: 1.2.3"),
            "CMakeLists.txt": ("VERSION ${version}", "VERSION 1.2.3"),
            "decoder/packages/arduino/library.properties": ("@VERSION@", "1.2.3"),
            "decoder/packages/cmsis-pack/microtin.microtin.pdsc": ('<release version="@VERSION@"', '<release version="1.2.3"'),
            "decoder/packages/esp-idf/idf_component.yml": ("@VERSION@", "1.2.3"),
            "decoder/packages/meson/meson.build": ("@VERSION@", "1.2.3"),
            "decoder/packages/npm/package.json": ("@VERSION@", "1.2.3"),
            "decoder/packages/platformio/library.json": ("@VERSION@", "1.2.3"),
            "pyproject.toml": ('dynamic = ["version", "urls", "readme"]', 'version = "1.2.3"'),
            "setup.py": ("version=version()", 'version="1.2.3"'),
        }

        def plant(folder):
            for name, (old, new) in places.items():
                replace(folder / name, old, new)

        reasons = [rf"{name}:\d+: states version 1.2.3, not {VERSION}; take" for name in places]
        self.refused(plant, *reasons, trial=False)

    def test_the_version_of_a_format(self):
        def plant(folder):
            replace(folder / "shared/pack_format.hpp", "kPackVersion = ", "kPackVersion = 1")
            log(folder, 25, 5)

        self.refused(plant, "format-pack.md:1: does not have the version .*; correct", trial=False)

    def test_change_logs(self):
        heading = f"## {VERSION} - 2026-12-01"
        for new, reason in (("## Unreleased", "has no section of 7.8.9; rename"), (f"## {VERSION}", "has no date; write"),
                            (f"## {VERSION} - 2026-13-01", "has no date; write"),
                            (f"{heading}\n\n## 2.0.0 - 2026-01-01", "is empty; write")):  # fmt: skip
            with self.subTest(new):
                self.refused(lambda folder: replace(folder / "CHANGELOG.md", heading, new), f"CHANGELOG.md: .*{reason}")

    def test_formats_that_are_not_frozen(self):
        for old, new, state in (("frozen since 1.0.0", "draft", "draft"), ("Status: ", "State: ", "missing"),
                                ("frozen since 1.0.0", "frozen since the release", "frozen since the release"),
                                ("frozen since", "not frozen since", "not frozen since 1")):  # fmt: skip
            with self.subTest(state):
                self.refused(lambda folder: [replace(folder / page, old, new) for page in (STREAM, PACK)],
                             *(f'{page}: the status of the format is "{state}"; freeze' for page in (STREAM, PACK)))  # fmt: skip

    def test_too_little_fuzzing(self):
        reason = r"fuzz/log.txt: has {} hours of fuzzing, {} with the decoder as it is, not 24 and 4; run"
        self.refused(lambda folder: log(folder, 23, 5), reason.format("23.0", "5.0"))
        self.refused(lambda folder: log(folder, 30, 3), reason.format("30.0", "3.0"))
        self.refused(lambda folder: replace(folder / HEADER, "#ifndef", "/* New. */\n#ifndef"), reason.format("25.0", "0.0"))

    def test_a_readme_that_states_otherwise(self):
        self.refused(lambda folder: replace(folder / "README.md", "## Limits\n", "## Limits\n\nIt is not frozen yet.\n"),
                     r"README.md:\d+: states that the format is not frozen; freeze")  # fmt: skip

    def test_an_address_that_is_not_the_projects(self):
        self.refused(lambda folder: replace(folder / "CMakeLists.txt", "microtin.test", "microtin.example"),
                     "HOMEPAGE_URL is a placeholder, .*; write")  # fmt: skip
        for url in ("https://microtin.test", "https://microtin.test/", "https://microtin.test/microtin/"):
            with self.subTest(url):
                self.refused(lambda folder: replace(folder / "CMakeLists.txt", "https://microtin.test/microtin", url),
                             f"HOMEPAGE_URL, {url}, is not a repository's; write https://HOST/PATH")  # fmt: skip
        self.refused(lambda folder: replace(folder / CONTROL, "microtin@microtin.test", "microtin@example.org"),
                     f"{CONTROL}: the address of the Maintainer is a placeholder; write")  # fmt: skip

    def test_files_that_are_there(self):
        def plant(folder):
            (folder / "build/artefacts" / VERSION).mkdir(parents=True)

        self.refused(plant, f"build/artefacts/{VERSION} is there already; move", committed=False, trial=False)

    def test_tools_that_are_not_installed(self):
        """Each part's tools, and of no part; a part that is left out needs none."""
        tools = self.ready.parent / f"{self.ready.name}-tools"
        tools.mkdir()
        self.addCleanup(shutil.rmtree, tools)
        for name in ("dirname", "git", "sed"):
            (tools / name).symlink_to(shutil.which(name))
        (tools / "python3").symlink_to(sys.executable)

        def refusal(*arguments):
            release = run(".ci/release", *arguments, VERSION, folder=self.ready, PATH=str(tools))
            self.assertEqual((release.returncode, release.stdout), (1, ""), release.stderr)
            return release.stderr

        self.assertEqual(refusal(), "refused: cmake is not installed; run .ci/install tool release\n")
        for name in ("cmake", "ninja", "g++", "clang++", "wasm-ld", "wasm-opt", "zopfli", "esbuild", "objdump"):
            (tools / name).symlink_to(shutil.which("false"))
        self.assertRegex(refusal(), r"^refused: .*g\+\+-posix is not installed; .*--without windows\n$")
        self.assertRegex(refusal("--without", "windows"), r"^refused: npm is not installed; .*--without npm\n$")
        self.assertFalse((self.ready / "build").exists())

    def test_wrong_arguments(self):
        for arguments in ([], ["next"], ["--without", "linux", VERSION], ["--sloppy", VERSION]):
            with self.subTest(arguments):
                release = run(".ci/release", *arguments, folder=self.ready)
                self.assertEqual(release.returncode, 2)
                self.assertRegex(release.stderr, r"^usage: release .*VERSION\n$")


class Archives(Folder):
    def test_bytes_depend_on_names_bytes_and_permissions(self):
        packed = []
        for order, time, mode in ((["b", "a/c"], 1, 0o600), (["a/c", "b"], 10**9, 0o644)):
            tree = Path(tempfile.mkdtemp(dir=self.folder))
            for name in order:
                (tree / name).parent.mkdir(exist_ok=True)
                (tree / name).write_text(f"content of {name}")
                (tree / name).chmod(mode)
                os.utime(tree / name, (time, time))
            packed.append((tree, self.packed(tree)))
        self.assertEqual(packed[0][1], packed[1][1])
        (tree / "b").chmod(0o755)
        for one, other in zip(self.packed(tree), packed[0][1]):
            self.assertNotEqual(one, other)

    def packed(self, tree):
        for name in ("x.tar.gz", "x.zip"):
            packing = run(sys.executable, ARTEFACTS / "archives.py", self.folder / name, tree, folder=self.folder, **EPOCH)
            self.assertEqual(packing.returncode, 0, packing.stderr)
        return [(self.folder / name).read_bytes() for name in ("x.tar.gz", "x.zip")]


class Finished(Folder):
    """A folder as .ci/release leaves it, of one archive."""

    def setUp(self):
        super().setUp()
        self.repository, self.out = self.folder / "repository", self.folder / "out"
        ready(self.repository)
        self.bill = self.out / f"microtin-{VERSION}.spdx.json"
        self.archive = self.out / f"microtin-{VERSION}-source.tar.gz"
        (self.folder / "source" / Path(HEADER).parent).mkdir(parents=True)
        shutil.copy(self.repository / HEADER, self.folder / "source" / HEADER)
        self.out.mkdir()
        self.tool("archives.py", self.archive, self.folder / "source")
        (self.out / "RELEASE_NOTES.md").write_text(self.tool("notes.py", VERSION, self.out))
        self.bill.write_text(self.tool("sbom.py", VERSION, self.out))
        self.sum()

    def tool(self, name, *arguments):
        tool = run(sys.executable, ARTEFACTS / name, *arguments, folder=self.repository, **EPOCH)
        self.assertEqual(tool.returncode, 0, tool.stderr)
        return tool.stdout

    def sum(self):
        (self.out / "SHA256SUMS").unlink(missing_ok=True)
        sums = run("sh", "-c", "sha256sum -- * >../sums && mv ../sums SHA256SUMS", folder=self.out)
        self.assertEqual(sums.returncode, 0, sums.stderr)

    def found(self):
        check = run(sys.executable, ARTEFACTS / "check.py", VERSION, self.out, folder=self.repository)
        return check.returncode, check.stderr

    def test_whole_files_pass_and_notes_come_from_the_change_log(self):
        self.assertEqual(self.found(), (0, ""))
        notes = (self.out / "RELEASE_NOTES.md").read_text()
        self.assertTrue(notes.startswith(f"# microtin {VERSION}\n\n### Added\n\n- A line.\n\n## Files\n"), notes)
        self.assertIn(f"| {self.archive.name} | the sources", notes)
        self.assertNotIn("Old.", notes)

    def test_other_bytes(self):
        self.archive.write_bytes(self.archive.read_bytes() + b"\0")
        code, text = self.found()
        self.assertEqual(code, 1)
        for fault in ("another checksum than in SHA256SUMS", "another SHA1 than", "another SHA256 than"):
            self.assertIn(fault, text)

    def test_a_file_that_nothing_names(self):
        (self.out / "more").write_text("")
        self.assertRegex(self.found()[1], "SHA256SUMS: does not name each file once: more\n.*does not list each file: more\n")

    def test_another_version_in_an_archive(self):
        replace(self.folder / "source" / HEADER, "VERSION_MAJOR 7", "VERSION_MAJOR 6")
        self.tool("archives.py", self.archive, self.folder / "source")
        self.assertIn(f"-source.tar.gz: include/microtin/microtin.h in it does not state version {VERSION}", self.found()[1])

    def test_each_fault_of_the_bill(self):
        sound = json.loads(self.bill.read_text())
        self.assertEqual({"CLI11", "stb_image_write", "zlib", "glibc", "libstdc++", "nlohmann-json", "microtin"},
                         {package["name"] for package in sound["packages"]})  # fmt: skip
        faults = [(lambda bill, name=name: bill.pop(name), f"has no {name}\n") for name in sound if name != "documentDescribes"]
        for kind, fields in (("packages", ("name", "downloadLocation", "licenseConcluded", "licenseDeclared", "copyrightText",
                                           "versionInfo")),
                             ("files", ("SPDXID", "licenseConcluded", "licenseInfoInFiles", "copyrightText")),
                             ("relationships", ("relationshipType",))):  # fmt: skip
            faults += [(lambda bill, kind=kind, name=name: bill[kind][-1].pop(name), f"has no {name}\n") for name in fields]
        faults += [
            (lambda bill: bill.update(spdxVersion="SPDX-2.2"), "is not SPDX 2.3"),
            (lambda bill: bill["packages"][0].update(versionInfo="1.2.3"), f"version is not {VERSION}"),
            (lambda bill: bill["packages"][0]["packageVerificationCode"].clear(), "its verification code is not"),
            (lambda bill: bill["packages"][1].update(SPDXID="SPDXRef-DOCUMENT"), "'SPDXRef-DOCUMENT': is not unique"),
            (lambda bill: bill["files"][0].update(SPDXID="SPDXRef-a_b"), "'SPDXRef-a_b': is not unique, or not an identifier"),
            (lambda bill: bill["files"].pop(), "does not list each file"),
            (lambda bill: bill["relationships"].pop(0), "describes no package"),
            (lambda bill: bill["relationships"][-1].update(relatedSpdxElement="SPDXRef-Gone"), "names SPDXRef-Gone"),
            (lambda bill: bill["creationInfo"].update(created="today"), "created is not a date"),
            (lambda bill: bill["creationInfo"].update(creators=[]), "has no creators"),
            (lambda bill: bill["files"][0]["checksums"].pop(), "has no SHA1 and SHA256"),
        ]
        sys.path.insert(0, str(ARTEFACTS))
        sys.dont_write_bytecode = True
        from check import bill_of_materials

        self.assertEqual(bill_of_materials(VERSION, self.out), [])
        for plant, expected in faults:
            with self.subTest(expected):
                bill = json.loads(json.dumps(sound))
                plant(bill)
                self.bill.write_text(json.dumps(bill))
                found = "\n".join([*bill_of_materials(VERSION, self.out), ""])
                self.assertIn(expected, found)


if __name__ == "__main__":
    if not shutil.which("git"):
        print("skipped: git is not installed")
        sys.exit(77)
    unittest.main()
