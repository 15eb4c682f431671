# SPDX-License-Identifier: MIT
"""conventions.py CHECK [FOLDER]: what people expect of a repository holds in this one, or in a folder.

length   the README has at most 150 lines
links    files and headings that the documents link to are there
pointers documents that sources and documents name are there
comments no comment begins as a fragment of a sentence
merges   no source or document has the marks that a conflict of a merge leaves
licence  every source names its licence
faults   the text that a planted fault replaces stands once in its source, and its name stands for no other
columns  documents have lines of at most 122 columns, tables and what links lead to aside
widths   no struct of a C header has an enumeration, whose width flags change, and no pointer leads to one
options  below the command line no text writes an option, which each user of the library spells in its own way
meanings names of unnamed namespaces have one meaning in a folder, whose sources may be compiled as one
locale   the encoder's library knows no decimal comma, whatever the program that uses it has chosen
parts    each program of .ci/parts runs in a workflow of .github, and workflows run no other
changelog the section of a version has entries of one line under Added, Changed, Fixed and Removed
wording  messages are clauses that name the fault: without a full stop, an exclamation mark, two blanks or "invalid"
prose    documents have short, plain sentences; the change log, the report of the benchmarks and laboratory notes may differ

conventions.py messages [FOLDER]: prints the texts of errors and warnings, "file:line: message", for people to read
"""

import functools
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.append(str(ROOT / "fuzz"))
from faults import read as planted_faults  # noqa: E402

MOST_LINES = 150
MOST_COLUMNS = 122
LICENCE = "SPDX-License-Identifier: MIT"
SLASHES = (".c", ".h", ".cpp", ".hpp", ".js")
HASHES = (".py", ".sh", ".cmake", "CMakeLists.txt")
MOST_WORDS = 40
MOST_WORDS_IN_MEAN = 18
# Words of another century, and verbs of speech for what programs do.
ODD_WORDS = re.compile(
    r"\b(told|tells?|says?|ask(s|ed|ing)?|wants?|hears?|heard|wish(es|ed)?|gives? up|beside|amid|aslant|dear(er|est)|so many|the like|but for|for want of|whoever|would-be|no longer)\b"
    r"|(?<!here )\b(is|are) (no|none)\b|^(Of|Beside|What|Where)\b"
)
COMMENT = re.compile(r"(^\s*|\s\s)(//|#|;|/\*|\*)")
# How a comment begins that needs its neighbours. "Of" begins no sentence whose subject comes first.
FRAGMENT = re.compile(r"(?:^\s*|\s\s)(//|/\*|#) (Of |\.\.\. ?|The same\b|As microtin_|[Ww]ith so many |[Ss]o many |Beside )")
CALL = re.compile(r"\b(\w+)\(")
COMMA = re.compile(r"\b(o?stringstream|sto[dfl]|stold|strto[df]|strtold|atof)\b|\bsn?printf\(.*%[-+ #0-9.*]*[aefg]", re.I)


def files(folder):
    """All but those of builds, and hidden ones other than .ci."""
    for path in sorted(folder.iterdir()):
        hidden = path.name.startswith(".") and path.name != ".ci"
        if path.is_dir() and path.name != "build" and not hidden:
            yield from files(path)
        elif path.is_file():
            yield path


def licence_line(path):
    """The line with which a source must begin, behind #! if it has that; None for what is no source."""
    if path.name.endswith(SLASHES):
        return f"// {LICENCE}"
    if path.name.endswith(".ld"):
        return f"/* {LICENCE} */"
    if path.name.endswith(".smt2"):
        return f"; {LICENCE}"
    script = "seeds" not in path.parts and "findings" not in path.parts and path.read_bytes()[:2] == b"#!"
    return f"# {LICENCE}" if script or path.name.endswith(HASHES) else None


def lines_of(path):
    return path.read_text().splitlines()


def documents(folder):
    return (path for path in files(folder) if path.suffix == ".md")


def length(folder):
    lines = len(lines_of(folder / "README.md"))
    return [f"README.md has {lines} lines, more than {MOST_LINES}"] if lines > MOST_LINES else []


def anchors(document):
    """What links to headings of a document may name."""
    headings = re.findall(r"^#+ (.*)$", document.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", heading).lower().replace(" ", "-") for heading in headings}


def links(folder):
    found = []
    for document in documents(folder):
        for target, heading in re.findall(r"\]\(([^)#:]*)(?:#([^)]*))?\)", document.read_text()):
            to = document.parent / target if target else document
            if not to.exists():
                found.append(f"{document.relative_to(folder)} links to {target}, which is not there")
            elif heading and to.suffix == ".md" and heading not in anchors(to):
                found.append(f"{document.relative_to(folder)} links to {target}#{heading}, which is not there")
    return found


def texts(folder):
    """Sources and documents, with the lines of each; not the history, which names what was."""
    for path in files(folder):
        if path.suffix == ".md" or licence_line(path) or path.name.endswith((".cmake", ".mjs", ".dict")):
            if path.name != "CHANGELOG.md" and "planted" not in path.parts[len(folder.parts):]:
                yield path, path.read_text().splitlines()


def pointers(folder):
    names = {document.name for document in documents(folder)}
    return [
        f"{path.relative_to(folder)}:{number} names {name}, which is not there"
        for path, lines in texts(folder)
        for number, line in enumerate(lines, 1)
        if path.suffix == ".md" or COMMENT.search(line)
        for name in re.findall(r"(?<![\w${}])[\w-]+\.md\b", line)
        if name not in names
    ]


def comments(folder):
    return [
        f"{path.relative_to(folder)}:{number} begins as a fragment: {begin.group().strip()}"
        for path, lines in texts(folder)
        if path.suffix != ".md"
        for number, (line, before) in enumerate(zip(lines, ["", *lines]), 1)
        if (begin := FRAGMENT.search(line))
        and not all(text.lstrip().startswith(begin.group(1)) for text in (line, before))
    ]


def columns(folder):
    return [
        f"{document.relative_to(folder)}:{number} is longer than {MOST_COLUMNS} columns"
        for document in documents(folder)
        for number, line in enumerate(lines_of(document), 1)
        if not line.startswith("|") and len(re.sub(r"\]\([^)]*\)", "]", line)) > MOST_COLUMNS
    ]


def merges(folder):
    return [
        f"{path.relative_to(folder)}:{number} has the mark of a conflict"
        for path, lines in texts(folder)
        for number, line in enumerate(lines, 1)
        if re.match(r"(<{7}|[|]{7}|>{7}) ", line)
    ]


def licence(folder):
    return [
        f"{path.relative_to(folder)} does not name its licence"
        for path in files(folder)
        if (line := licence_line(path)) and line not in lines_of(path)[:2]
    ]


@functools.cache
def called_in(path):
    """What the sources of a folder, or one source, call or define."""
    kinds = (".cpp", ".hpp", ".h", ".js", ".py")
    sources = [source for source in (files(path) if path.is_dir() else [path]) if source.suffix in kinds]
    return {name for source in sources for name in CALL.findall(source.read_text())}


def faults(folder):
    planted = planted_faults(folder)
    names = [fault.name for fault in planted]
    found = [f"{name} names two faults" for name in sorted(set(names)) if names.count(name) > 1]
    for fault in planted:
        if fault.count_in(folder) != 1:
            found.append(f"{fault.name} replaces what is not found exactly once in {fault.source}")
        tops = [folder / top for top in (fault.source.split("/")[0], "decoder", "shared") if (folder / top).exists()]
        for name in sorted(set(CALL.findall(fault.new)).difference(*map(called_in, tops))):
            found.append(f"{fault.name} calls {name}, which is not there")
    return found


def widths(folder):
    """An enumeration has one byte with -fshort-enums, and four without: none is in a struct or behind a pointer."""
    tops = [folder / top for top in ("decoder/include", "decoder/adapters", "encoder/include")]
    headers = [path for top in tops if top.exists() for path in files(top) if path.suffix == ".h"]
    names = "|".join(name for path in headers for name in re.findall(r"typedef enum (\w+)", path.read_text()))
    kind = rf"\b(?:enum\s+\w+|{names})\b"
    found = []
    for path in headers:
        in_struct = False
        for number, text in enumerate(lines_of(path), 1):
            line = re.sub(r"/\*.*?(\*/|$)|^ \*.*", "", text)
            in_struct = in_struct and not line.startswith("}") or line.startswith("typedef struct") and "{" in line
            if re.search(rf"{kind}\s*(?:const\s*)?[*\[]", line) or in_struct and re.search(rf"{kind} \w|\benum {{", line):
                found.append(f"{path.relative_to(folder)}:{number} has the width of an enumeration, which flags change")
    return found


DECLARED = re.compile(
    r"(?:struct|class|enum class|enum|union)\s+(\w+)[^;()]*\{|(?:constexpr|const)\s[^=({;]*?\b(k[A-Z]\w*)\b\s*(?:=|\{|\[)"
)
BLANKED = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)


def unnamed(path):
    """The types and constants that a source declares in unnamed namespaces, with the namespaces around them."""
    text, scopes, start, found = BLANKED.sub("", path.read_text()), [], 0, set()
    for brace in re.finditer(r"[{};]", text):
        part, start = text[start : brace.end()], brace.end()
        if "" in scopes and None not in scopes:
            found |= {(*scopes, one or other) for one, other in DECLARED.findall(part)}
        if brace.group() == "{":
            opened = re.search(r"namespace\s*([\w:]*)\s*\{$", part)
            scopes.append(opened.group(1) if opened else None)
        elif brace.group() == "}" and scopes:
            scopes.pop()
    return found


def meanings(folder):
    """Sources of benchmarks and of images for devices are compiled one by one."""
    found, first = [], {}
    for top in ("encoder", "tests"):
        for path in files(folder / top) if (folder / top).exists() else []:
            if path.suffix != ".cpp" or {"bench", "firmware", "paper", "device"} & set(path.parts):
                continue
            for name in sorted(unnamed(path)):
                other = first.setdefault((path.parent.name, *name), path)
                if other != path:
                    found.append(f"{path.relative_to(folder)} declares {name[-1]}, as {other.relative_to(folder)} does")
    return found


def locale(folder):
    """The commands, and the pictures that they draw, run in the C locale."""
    return [
        f"{path.relative_to(folder)}:{number} follows the locale"
        for path in files(folder / "encoder")
        if path.name.endswith((".cpp", ".hpp")) and path.parent.name not in ("cli", "picture")
        for number, line in enumerate(lines_of(path), 1)
        if COMMA.search(line)
    ]


LITERAL = r'"(?:[^"\\\n]|\\.)*"'
BELOW_CLI = ("cli", "docs", "viewer")


def without_comments(path):
    return re.sub(rf"({LITERAL})|//[^\n]*", lambda found: found.group(1) or "", path.read_text())


def options(folder):
    """Errors name parameters (base::parameter), and the command line adds the hyphens."""
    return [
        f"{path.relative_to(folder)}:{number} writes an option: {text}"
        for path in files(folder / "encoder")
        if path.name.endswith((".cpp", ".hpp")) and path.relative_to(folder / "encoder").parts[0] not in BELOW_CLI
        for number, line in enumerate(without_comments(path).split("\n"), 1)
        for text in re.findall(LITERAL, line)
        if re.search(r"--[a-z]", text)
    ]


KINDS_OF_CHANGE = ("Added", "Changed", "Fixed", "Removed")
# What makes a message: exceptions, and the functions that throw or print one.
MESSAGE = re.compile(r"""
    \b(?:\w*Error|Damaged|InternalFault|ReportLost|NobodyReads|fail\w*|refuse\w*|expect\w*|warn\w*|announce\w*|with_place)
    \((?=[^;{]*") | \b(?:return|case\s\w+:\s*return)\s(?=[^;{]*"[^"]*[ ][^"]*") """, re.X)


def arguments(text, start):
    """The rest of a call or statement: to the parenthesis that closes it, or to the semicolon."""
    depth = 0
    for found in re.compile(rf"{LITERAL}|'(?:[^'\\]|\\.)'|[()\[\]{{}};]").finditer(text, start):
        sign = found.group()
        depth += (sign in "([{") - (sign in ")]}") if len(sign) == 1 else 0
        if depth < 0 or (sign == ";" and depth <= 0):
            return text[start:found.start()]
    return ""


def all_messages(folder):
    """File, line and text of each message, its variable parts as "..."."""
    for path in files(folder / "encoder"):
        if not path.name.endswith((".cpp", ".hpp", ".py")):
            continue
        is_python = path.suffix == ".py"
        text, ends = path.read_text() if is_python else without_comments(path), 0
        for found in re.finditer(r"raise \w+\(", text) if is_python else MESSAGE.finditer(text):
            if found.start() < ends:
                continue
            parts = arguments(text, found.end())
            words = re.sub(rf"{LITERAL}|[^\"]+", lambda part: part.group()[1:-1] if part.group()[0] == '"' else "\0", parts)
            words = re.sub(r"\0(?:parameter)?", "...", re.sub(r'parameter\("(\w+)"\)', r"\1", words))
            if re.search(r"[a-z] [a-z]", words):
                ends = found.end() + len(parts)
                number = text.count("\n", 0, found.start()) + 1
                yield path.relative_to(folder), number, words


def messages(folder):
    for path, number, words in all_messages(folder):
        print(f"{path}:{number}: {words}")
    return []


def wording(folder):
    """A message is a clause that names the fault and, after a semicolon or a colon, the remedy: no sentence, no appeal."""
    found = []
    for path, number, words in all_messages(folder):
        text = re.sub(r"\.\.\.|\\n", " ", words).strip()
        reasons = (
            (text.endswith((".", ";")) and not words.endswith("..."), "ends with a stop"),
            (re.search(r"!(?!r\b)", text), "has an exclamation mark"),
            (re.search(r"[a-z;:,]  +[a-z]", words), "has two blanks"),
            (re.search(r"\b(please|sorry|invalid|illegal|oops)\b", text, re.I), "does not name the fault"),
        )
        found += [f"{path}:{number} {reason}: {words}" for holds, reason in reasons if holds]
    return found


def paragraphs(document):
    """Number of the first line and text of each paragraph or list item; without code, tables, headings and pictures."""
    text, first, fenced = "", 0, False
    for number, line in enumerate([*lines_of(document), ""], 1):
        fenced ^= line.startswith("```")
        item = re.match(r" *([-*]|[0-9]+\.) ", line)
        if fenced or not line.strip() or item or re.match(r"[|#!`]|    ", line):
            if text:
                yield first, text
            text = line[item.end():] if item and not fenced else ""
            first = number
        else:
            first = number if not text else first
            text = f"{text} {line}".strip()


def sentences(document):
    for number, text in paragraphs(document):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "code", text)).replace("*", "")
        for sentence in re.split(r"(?<=[.:?]) +(?=[A-Z\"(])", plain):
            yield number, sentence


def prose(folder):
    found = []
    for document in documents(folder):
        name, lengths = document.relative_to(folder), []
        if name.name in ("CHANGELOG.md", "REPORT.md") or "lab" in name.parts:
            continue
        for number, sentence in sentences(document):
            lengths.append(len(sentence.split()))
            if lengths[-1] > MOST_WORDS:
                found.append(f"{name}:{number} has a sentence of {lengths[-1]} words, more than {MOST_WORDS}")
            if odd := ODD_WORDS.search(sentence):
                found.append(f"{name}:{number} says {odd.group()!r}: {sentence[:60]}")
        if lengths and sum(lengths) > MOST_WORDS_IN_MEAN * len(lengths):
            found.append(f"{name} has {sum(lengths) / len(lengths):.1f} words a sentence, more than {MOST_WORDS_IN_MEAN}")
    return found


def changelog(folder):
    """Sections of versions; those of formats before 1.0 are history. A list may have topics ("Devices:") and tables."""
    found, headings = [], None
    for number, line in enumerate(lines_of(folder / "CHANGELOG.md"), 1):
        if line.startswith("## "):
            headings = [] if re.fullmatch(r"## (Unreleased|\d+\.\d+\.\d+( - \S+)?)", line) else None
        elif headings is not None and line.startswith("### "):
            headings.append(line[4:])
            if headings != [name for name in KINDS_OF_CHANGE if name in headings]:
                found.append(f"CHANGELOG.md:{number} has {line[4:]}, not Added, Changed, Fixed, Removed in this order")
        elif headings and not re.fullmatch(r"|- .*|[A-Z].*:| *\|.*", line):
            found.append(f"CHANGELOG.md:{number} is not an entry of one line: {line[:40]}")
    return found


def parts(folder):
    programs = {program.name for program in (folder / ".ci/parts").iterdir()}
    text = "\n".join(workflow.read_text() for workflow in sorted((folder / ".github/workflows").glob("*.yml")))
    run = set(re.findall(r"\.ci/run (\w+)", text)) | set(re.findall(r"\blist: (\w+)", text))
    run |= {name for names in re.findall(r"\blist: \[([^]]*)\]", text) for name in names.split(", ")}
    return [f"no workflow runs .ci/parts/{name}" for name in sorted(programs - run)] + [
        f"a workflow runs {name}, which .ci/parts does not have" for name in sorted(run - programs)
    ]


def main():
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT
    checks = {check.__name__: check for check in (length, links, pointers, comments, columns, merges, licence, faults, widths, options, meanings, locale, parts, changelog, wording, prose, messages)}
    found = checks[sys.argv[1]](folder)
    for fault in found:
        print("rejected:", fault)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
