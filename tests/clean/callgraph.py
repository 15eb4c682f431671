# SPDX-License-Identifier: MIT
"""callgraph.py OBJECT...: rejects recursion, indirect calls and frames whose size is not constant, by the call
graph that gcc wrote next to each object (-fcallgraph-info=su,da)."""

import graphlib
import re
import sys
from pathlib import Path


def read_graph(objects):
    """The callees of each function, and the functions with a frame whose size is not constant."""
    callees, unsized = {}, []
    for path in objects:
        text = Path(path).with_suffix(".ci").read_text()
        for name, label in re.findall(r'^node: \{ title: "([^"]*)" label: "([^"]*)"', text, re.M):
            callees.setdefault(name, set())
            if re.search(r" bytes \(dynamic\)", label):
                unsized.append(name)
        for caller, callee in re.findall(
            r'^edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"', text, re.M
        ):
            callees[caller].add(callee)
    return callees, unsized


def faults(objects):
    callees, unsized = read_graph(objects)
    if not any(callees.values()):
        yield "no calls at all: " + " ".join(objects)
    for name in unsized:
        yield f"frame of varying size: {name}"
    for caller, names in callees.items():
        if "__indirect_call" in names:
            yield f"indirect call: {caller}"
    try:
        graphlib.TopologicalSorter(callees).prepare()
    except graphlib.CycleError as error:
        yield "recursion: " + " -> ".join(error.args[1])


found = list(faults(sys.argv[1:]))
for fault in found:
    print("rejected:", fault)
sys.exit(1 if found else 0)
