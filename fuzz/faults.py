# SPDX-License-Identifier: MIT
"""The planted faults of fuzz/mutants. fuzz/mutate describes their files."""


class Fault:
    def __init__(self, source, name):
        self.source = source
        self.name = name
        self.old = ""
        self.new = ""

    def count_in(self, folder):
        """How often the source has the lines that the fault replaces; 0 without a source."""
        source = folder / self.source
        return source.read_text().count(self.old) if self.old and source.exists() else 0

    def plant(self, folder):
        if self.count_in(folder) != 1:
            raise ValueError(f"{self.name} replaces what is not found exactly once in {self.source}")
        source = folder / self.source
        source.write_text(source.read_text().replace(self.old, self.new))


def read_file(path):
    source, found = None, []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        word, _, rest = line.partition(" ")
        if word == "source" and source is None:
            source = rest
        elif word == "fault" and source is not None:
            found.append(Fault(source, rest))
        elif line[:1] == "-" and found:
            found[-1].old += line[1:] + "\n"
        elif line[:1] == "+" and found:
            found[-1].new += line[1:] + "\n"
        elif line and line[0] != "#":
            raise ValueError(f"{path}:{number} is neither a source, a fault, one of its lines nor a remark: {line}")
    return found


def read(folder):
    """All faults of the repository in a folder."""
    return [fault for path in sorted((folder / "fuzz/mutants").glob("*.txt")) for fault in read_file(path)]
