# SPDX-License-Identifier: MIT
"""The most bytes of stack that calls of some functions take, callees and compiler helpers included: calls from the
disassembly, frames from gcc's call-graph files or, where a function is in none, from its instructions."""

import re
import subprocess
from pathlib import Path


class Unbounded(Exception):
    pass


# For each processor: bytes that a call itself takes, which gcc counts to the frame; what a call or a jump to another function looks like; an
# indirect call; and the ways to take stack, with the bytes or a number of registers that each takes.
class Arm:
    call_bytes = 0
    call = r"(bl?x?|b[a-z]{2}|cbn?z)(\.[nw])?\s"
    indirect = r"blx\s+r\d"
    takes = [
        (r"push\s+\{(.*)\}", lambda m: 4 * registers(m[1])),
        (r"stmdb\s+sp!, \{(.*)\}", lambda m: 4 * registers(m[1])),
        (r"subw?(?:\.w)?\s+sp, (?:sp, )?#(\d+)", lambda m: int(m[1])),
        (r"str[a-z.]*\s.*\[sp, #-(\d+)\]!", lambda m: int(m[1])),
    ]
    unknown = r"(subw?|mov|add)[a-z.]*\s+sp, (sp, )?r\d|vpush"


class RiscV:
    call_bytes = 0
    call = r"(jal|j|b[a-z]+)\s"
    indirect = r"jalr\s+(ra,)?[a-z]\d"
    takes = [(r"addi?\s+sp,sp,-(\d+)", lambda m: int(m[1]))]
    unknown = r"sub\s+sp,|add\s+sp,sp,[a-z]"


class Avr:
    call_bytes = 2
    call = r"(r?call|r?jmp|br[a-z]+)\s"
    indirect = r"e?icall"
    takes = [
        (r"(?:framed )?push\s", lambda m: 1),
        (r"rcall\s+\.\+0\b", lambda m: 2),
        # Only behind `in r28, SPL; in r29, SPH`; elsewhere this is no change of the stack.
        (r"framed sbiw\s+r28, 0x([0-9a-fA-F]+)", lambda m: int(m[1], 16)),
        (r"framed subi\s+r28, 0x([0-9a-fA-F]+)", lambda m: int(m[1], 16)),
        (r"framed sbci\s+r29, 0x([0-9a-fA-F]+)", lambda m: 256 * int(m[1], 16)),
    ]
    unknown = r"(?!)"


class X86:
    call_bytes = 4
    call = r"(call|j[a-z]+)\s"
    indirect = r"call\s+\*"
    takes = [
        (r"push\s", lambda m: 4),
        (r"sub\s+\$0x([0-9a-f]+),%esp", lambda m: int(m[1], 16)),
    ]
    unknown = r"sub\s+%\w+,%esp|and\s+.*%esp"


class S390x:
    call_bytes = 0
    call = r"(brasl|jg[a-z]*|j[a-z]*|brcl?)\s"
    indirect = r"basr\s"
    takes = [
        (r"(?:aghi|agfi)\s+%r15,-(\d+)", lambda m: int(m[1])),
        (r"lay\s+%r15,-(\d+)\(%r15\)", lambda m: int(m[1])),
    ]
    unknown = r"sgr\s+%r15"


PROCESSORS = [
    ("cortex", Arm), ("rv32", RiscV), ("avr", Avr), ("i386", X86), ("s390x", S390x)
]  # fmt: skip


def registers(names):
    """How many registers a list like "r4, r6-r8, lr" names."""
    number = {"sl": 10, "fp": 11, "ip": 12, "sp": 13, "lr": 14, "pc": 15}
    ends = [[number.get(n) or int(n[1:]) for n in r.split("-")] for r in names.split(", ")]
    return sum(e[-1] - e[0] + 1 for e in ends)


def known_frames(call_graphs):
    """Frames by function, from files that -fcallgraph-info=su wrote."""
    frames = {}
    for path in call_graphs:
        node = r'^node: \{ title: "(?:[^"]*:)?([^":]*)" label: "[^"]*\\n(\d+) bytes \(([a-z,]*)\)'
        for name, size, kind in re.findall(node, Path(path).read_text(), re.M):
            if kind == "dynamic":
                raise Unbounded(f"{name}: a frame of varying size")
            frames[name] = max(int(size), frames.get(name, 0))
    return frames


class Stack:
    def __init__(self, target, objdump, image, call_graphs, has_callbacks=False):
        """With callbacks, calls through pointers are of the firmware's own functions and not counted."""
        self.has_callbacks = has_callbacks
        self.processor = next(p for name, p in PROCESSORS if target.startswith(name))
        self.known = known_frames(call_graphs)
        self.before, self.loaded, self.returned = "", [0, 0], False
        self.frames, self.callees, self.trouble, self.depths, self.inside = {}, {}, {}, {}, {}
        text = subprocess.run([objdump, "-d", image], check=True, capture_output=True, text=True)
        self.read(text.stdout)

    def read(self, disassembly):
        name = None
        for line in disassembly.splitlines():
            if head := re.match(r"[0-9a-f]+ <(.*)>:$", line):
                # A label within a helper; the compiler's own functions have a frame in its files.
                if name and head[1].startswith(name + "_") and head[1] not in self.known:
                    self.inside[head[1]] = name
                    continue
                name = head[1]
                self.frames[name], self.callees[name] = 0, set()
            elif name and (fields := line.split("\t", 2))[2:]:
                self.read_instruction(name, fields[2].replace("\t", " "))

    def read_instruction(self, name, code):
        for pattern, size in self.processor.takes:
            if match := re.match(pattern, self.before + code):
                self.frames[name] += size(match)
        # AVR's helper takes a frame of r26:r27, and stores 18 registers or, two bytes further, one less.
        if match := re.match(r"ldi\s+r2([67]), 0x(..)", code):
            self.loaded[int(match[1]) - 6] = int(match[2], 16)
        if match := re.search(r"<__prologue_saves__(?:\+0x([0-9a-f]+))?>", code):
            self.frames[name] += self.loaded[0] + 256 * self.loaded[1] + 18 - int(match[1] or "0", 16) // 2
            return
        # What follows the other, a jump to the function's end, is never met.
        returned, self.returned = self.returned, "<__epilogue_restores__" in code
        if self.returned or (returned and code.startswith(("rjmp", "jmp"))):
            return
        # AVR moves r28:r29 for other reasons too.
        if re.match(r"in\s+r29, 0x3e", code):
            self.before = "framed "
        elif not code.startswith(("sbiw", "subi")):
            self.before = ""
        if name not in self.known and re.match(self.processor.unknown, code):
            self.trouble[name] = "a frame of unknown size: " + code
        if re.match(self.processor.indirect, code) and not self.has_callbacks:
            self.trouble[name] = "an indirect call: " + code
        target = re.search(r"<([^+>]*)>", code)
        if target and re.match(self.processor.call, code):
            # A jump to the own start is a loop, a call of it recursion.
            callee = self.inside.get(target[1], target[1])
            if callee != name or "call" in code or code.startswith(("bl", "jal", "brasl")):
                self.callees[name].add(callee)

    def depth(self, name, above=()):
        """Of a call of the function. The mem functions are the firmware's own and not counted."""
        if name not in self.frames:
            return 0
        if name in self.trouble or name in above:
            raise Unbounded(f"{name}: {self.trouble.get(name, 'recursion')}")
        if name not in self.depths:
            below = [self.depth(callee, (*above, name)) for callee in self.callees[name]]
            own = self.known.get(name, self.frames[name] + self.processor.call_bytes)
            self.depths[name] = own + max(below, default=0)
        return self.depths[name]
