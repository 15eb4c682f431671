# SPDX-License-Identifier: MIT
"""commands.py MICROTIN [FOLDER]: every command line of microtin in the documents, or in those of a folder, has a command
and options that `microtin reference` lists, values that they take, and the options that a command requires. An option or a
command that stands alone in a text exists, too."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from conventions import ROOT, documents  # noqa: E402

# Options of other programs, such as .ci/release, and of builds with GDAL.
ALONE = ("--help", "--version", "reference", "manual", "completion")
OTHERS = {"--gc-sections", "--preset", "--trial", "--allow-vrt", "--band"}
SEPARATORS = ("|", "||", "&&", ";", "&")


class Command:
    def __init__(self, section):
        self.values, self.required = {"-h": "", "--help": ""}, []
        for names, text in re.findall(r"^\| `(-.*?)` \| (.*) \|$", section, re.M):
            forms = [name.split(" ", 1) for name in names.split(", ")]
            value = forms[-1][1].replace("\\|", "|") if len(forms[-1]) > 1 else ""
            self.values.update({form[0]: value for form in forms})
            if "(required)" in text:
                self.required.append([form[0] for form in forms])


def commands_of(program):
    reference = subprocess.run([program, "reference"], capture_output=True, text=True, check=True).stdout
    sections = re.split(r"^## ", reference, flags=re.M)[1:]
    return {s.split("\n", 1)[0]: Command(s) for s in sections if not s.startswith("All commands")}


def faults(words, commands, whole):
    """What is wrong with the words behind the name of the program."""
    if words[0] in (*ALONE, "COMMAND"):
        return
    if words[0] not in commands:
        yield f"{words[0]} is not a command"
        return
    command, given = commands[words[0]], []
    for at, word in enumerate(words[1:], 1):
        name, _, value = word.partition("=")
        if not re.match(r"--?[a-z]", word):
            continue
        given.append(name)
        if name not in command.values:
            yield f"{words[0]} has no option {name}"
            continue
        choices = command.values[name].split("|")
        value = value or "".join(words[at + 1:at + 2])
        if len(choices) > 1 and value not in choices and not any(c.isupper() for c in choices):
            yield f"{words[0]} {name} takes {' or '.join(choices)}, not {value}"
    if whole:
        for names in command.required:
            if not set(names) & set(given):
                yield f"{words[0]} requires {names[-1]}"


def command_lines(line):
    """The words behind each `microtin` of a shell's line."""
    line = re.sub(r"\$\([^)]*\)", "$", re.sub(r"(^|\s)#(\s.*)?$", "", line))
    words = shlex.split(re.sub(r"([;|<>]+)", r" \1 ", line.replace("\\|", "|")))
    for at, word in enumerate(words):
        if word.split("/")[-1] == "microtin" and at + 1 < len(words):
            end = next((i for i in range(at, len(words)) if words[i] in SEPARATORS), len(words))
            yield words[at + 1:end]


def shell_lines(text):
    """Number and text of each line of a block of commands."""
    fence = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            fence = line[3:] if fence is None else None
        elif fence == "sh" or fence is None and line.startswith("    "):
            yield number, line


def spans(text):
    """Number of the line and text of each span of code in a sentence or a table."""
    plain = re.sub(r"^```.*?^```$|^    .*?$", lambda block: "\n" * block[0].count("\n"), text, flags=re.M | re.S)
    for match in re.finditer(r"`([^`]+)`", plain):
        yield plain.count("\n", 0, match.start()) + 1, " ".join(match[1].split())


def check(text, commands):
    lines = [(number, words, True) for number, line in shell_lines(text) if "microtin " in line for words in command_lines(line)]
    options = OTHERS.union(ALONE, *(command.values for command in commands.values()))
    for number, span in spans(text):
        first = span.split()[0]
        if first.split("/")[-1] == "microtin" and " " in span:
            lines += [(number, words, False) for words in command_lines(span)]
        elif first in commands and " -" in span:
            lines.append((number, span.split(), False))
        elif first.startswith("--") and first.split("=")[0] not in options:
            yield number, f"no command has the option {first}"
    for number, words, whole in lines:
        for fault in faults(words, commands, whole):
            yield number, fault
    yield len(lines), None


def main():
    commands = commands_of(sys.argv[1])
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT
    checked = rejected = 0
    for document in documents(folder):
        if document.name == "CHANGELOG.md" or "lab" in document.parts:
            continue
        for number, fault in check(document.read_text(), commands):
            if fault is None:
                checked += number
            else:
                rejected += 1
                print(f"rejected: {document.relative_to(folder)}:{number}: {fault}")
    print(f"{checked} commands, {rejected} rejected")
    sys.exit(1 if rejected or not checked else 0)


main()
