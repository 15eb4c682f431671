# SPDX-License-Identifier: MIT
"""What the decoder needs on each device: measured, held to a budget, and written to the documents.

footprint.py measure ...: measures one target's libraries, writes BUILD/footprint.json and fails if a number is
above the budget. footprint.py record [BUILD...]: makes the measured numbers the budget and the documents'
tables. footprint.py documents: fails unless the documents' tables are the budget's.
"""

import argparse
import json
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import boards
import stack

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
BUDGET = HERE / "budget.json"

DECODING = ["read_stream_info", "mesh_init", "decoder_init", "decoder_feed", "decoder_finish"]
QUERIES = ["mesh_height_at", "axis_to_lattice", "mesh_vertex", "mesh_triangle", "mesh_neighbour", "mesh_digest"]
BUCKETS = ["buckets_init", "buckets_hint"]
COMPACT = ["compactor_init", "compactor_run", "compactor_required_bytes", "compact_height_at", "compact_hint"]
PACK = ["pack_init", "pack_load", "pack_next_read", "pack_complete_read", "pack_align_reads", "pack_bad_tile", "pack_get_info"]
PACK_QUERIES = ["pack_height_at", "pack_axis_to_lattice", "pack_segment_extremes", "pack_sample_grid"]
NOTES = ["note_finder_init", "note_finder_feed"]
SAFE_HEIGHTS = ["mesh_safe_heights_at"]
SEGMENTS = ["mesh_segment_extremes"]
REQUESTS = ["requests_init", "requests_add", "requests_next", "requests_note", "requests_pending"]
PACK_CHECK = ["pack_check_segment", "pack_check_box"]
PACK_BOUNDS = ["pack_bounds_on_segment", "pack_bounds_in_box"]
CLEARANCE = ["mesh_path_clearance"]
PROFILE = ["mesh_profile_next"]
PACK_PROFILE = ["pack_profile_next"]
GRADIENT = ["mesh_gradient_at"]
PACK_GRADIENT = ["pack_gradient_at"]
PLACES = ["mesh_heights_at", "mesh_grid_extremes"]
EDGE_MARKS = ["edge_marks_init", "edge_marks_feed", "edge_marks_finish", "edge_marks_count", "edge_marks_class"]
PACK_SEARCH = ["pack_search_path"]
COMPACT_PACK_SEARCH = ["compact_pack_search_path"]
COMPACT_PACK_PROFILE = ["compact_pack_profile_next"]
COMPACT_PACK = [{"pack_init": "compact_pack_init", "pack_load": "compact_pack_load"}.get(e, e) for e in PACK]
COMPACT_PACK_QUERIES = ["compact_" + e if e != "pack_axis_to_lattice" else e for e in PACK_QUERIES]
USES = {
    "decoding": DECODING,
    "queries": DECODING + QUERIES,
    "buckets": DECODING + QUERIES + BUCKETS,
    "compact": DECODING + COMPACT,
    "pack": PACK + ["pack_height_at"],
    "pack_queries": PACK + PACK_QUERIES,
    "compact_pack": COMPACT_PACK + ["compact_pack_height_at"],
    "compact_pack_queries": COMPACT_PACK + COMPACT_PACK_QUERIES,
    "notes": NOTES,
    "safe_heights": DECODING + SAFE_HEIGHTS,
    "segments": DECODING + SEGMENTS,
    "pack_check": PACK + PACK_CHECK + ["pack_height_at"],
    "pack_bounds": PACK + PACK_BOUNDS + ["pack_height_at"],
    "requests": PACK + REQUESTS + ["pack_height_at"],
    "clearance": DECODING + CLEARANCE,
    "profile": DECODING + PROFILE,
    "pack_profile": PACK + PACK_PROFILE,
    "compact_pack_profile": COMPACT_PACK + COMPACT_PACK_PROFILE,
    "gradient": DECODING + GRADIENT,
    "pack_gradient": PACK + PACK_GRADIENT,
    "places": DECODING + PLACES,
    "edge_marks": DECODING + EDGE_MARKS,
    "pack_search": PACK + PACK_SEARCH,
    "compact_pack_search": COMPACT_PACK + COMPACT_PACK_SEARCH,
}
# What is measured of the decoder in one source, by each compiler.
ONE_SOURCE_USES = {
    "decoding": DECODING,
    "queries": DECODING + QUERIES,
    "pack_queries": PACK + PACK_QUERIES,
    "all": DECODING + QUERIES + BUCKETS + COMPACT + PACK + PACK_QUERIES + COMPACT_PACK + COMPACT_PACK_QUERIES,
}
# What is measured of the decoder that switches of config.h make smaller.
SWITCH_USES = {"decoding": DECODING, "queries": DECODING + QUERIES}
# What is measured with hooks for a lock. What has no packs must not change.
LOCK_USES = {use: USES[use] for use in ("pack", "pack_queries", "compact_pack", "compact_pack_queries", "requests")}
LOCKLESS_USES = {use: entries for use, entries in USES.items() if "pack" not in use and use != "requests"}
ADAPTERS = ("inav", "ardupilot")
LOADING = r"_(load|load_card|check)$"  # functions of adapters that call the firmware's own, for a task that may wait
MOST_OF_CLANG = 1.2  # times gcc's bytes
MOST_OF_ONE_SOURCE = 1.04  # times the instructions of separate sources
WIDTH_IN_NAME = ["read_stream_info", "mesh_init", "decoder_init", "buckets_init", "compactor_init", "pack_init",
                 "compact_pack_init", "edge_marks_init"]


# --- Measuring ------------------------------------------------------------------------------------


def symbol(options, entry):
    """A function's name in the library: those to which the width of numbers matters tell it."""
    return f"microtin_{entry}_{options.bits}" if entry in WIDTH_IN_NAME else "microtin_" + entry


def link(options, library, entries, image):
    """Links what some entries need of a library, the compiler's helpers included, and nothing else."""
    link_names(options, [library], [symbol(options, entry) for entry in entries], image)


def link_names(options, files, names, image):
    """Links what functions need of objects and libraries."""
    command = [*options.compiler.split(), "-nostdlib", "-Wl,--gc-sections", *files, "-o", image]
    if options.target == "wasm32":
        command += ["-fuse-ld=lld", "-Wl,--no-entry,--allow-undefined,--strip-all"]
        command += ["-Wl,--export=" + name for name in names]
    else:
        command += ["-static", "-lgcc", "-Wl,--unresolved-symbols=ignore-all", "-Wl,-e," + names[0]]
        command += ["-Wl,-u," + name for name in names]
    if options.target == "xtensa":
        command += ["-Wl,-Ttext=0x1000"]  # within reach of the helpers that its libgcc lacks
    if options.target == "avr":
        command += ["-Wl,--defsym=__TEXT_REGION_LENGTH__=0x80000"]  # all at -O2 is more than the device has
    subprocess.run(command, check=True)


def section_bytes(options, image):
    """Bytes of code, constants, and data that is initialised or zero."""
    run = subprocess.run([options.objdump, "-h", image], check=True, capture_output=True, text=True)
    kinds = {"text": 0, "rodata": 0, "data": 0, "bss": 0}
    # The linker of RISC-V puts small constants next to small data, of which the library has none.
    others = {"CODE": "text", "DATA": "rodata", ".sdata": "rodata"}
    for name, size in re.findall(r"^ *\d+ ([^ ]+) +([0-9a-f]{8})", run.stdout, re.M):
        kind = re.match(r"\.(text|rodata|data|bss)", name)
        kind = kind[1] if kind else others.get(name)
        if kind:
            kinds[kind] += int(size, 16)
    return kinds


def measure_uses(options, library, uses):
    image = str(options.build / "linked")
    result = {}
    for use, entries in uses.items():
        link(options, library, entries, image)
        result[use] = section_bytes(options, image)
    return result


def stack_of(options, objects, image):
    """The stack of a linked image, of objects whose call graphs the compiler wrote."""
    graphs = [str(Path(o).with_suffix(".ci")) for o in objects.split(":")]
    graphs = [graph for graph in graphs if Path(graph).exists()]
    return stack.Stack(options.target, options.objdump, image, graphs)


def depth_of(options, calls, entries):
    return max(calls.depth(symbol(options, entry)) for entry in entries)


def measure_switches(options):
    """Builds without what a combination of switches leaves out."""
    result = {}
    for combination, library, objects in (given.split("=") for given in options.switches):
        image = str(options.build / "linked")
        result[combination] = measure_uses(options, library, SWITCH_USES)
        link(options, library, DECODING, image)
        result[combination]["stack_decoding"] = depth_of(options, stack_of(options, objects, image), DECODING)
    return result


def symbols_of(options, path, section):
    """Names and sizes of the global symbols of an object that are in a section."""
    run = subprocess.run([options.objdump, "-t", path], check=True, capture_output=True, text=True)
    found = re.findall(rf"^[0-9a-f]+ g .{{5}} {section}\S*\t([0-9a-f]+) (\w+)$", run.stdout, re.M)
    return {name: int(size, 16) for size, name in found}


def measure_adapter(options, path, ram, image):
    """One adapter: its own code, what it links of the decoder and of the compiler's helpers, and its stack."""
    names = list(symbols_of(options, path, ".text"))
    link_names(options, [path, options.Os], names, image)
    graphs = [str(Path(o).with_suffix(".ci")) for o in [path, *options.objects[options.Os].split(":")]]
    calls = stack.Stack(options.target, options.objdump, image, graphs, has_callbacks=True)
    loading = [name for name in names if re.search(LOADING, name)]
    return {
        "own": section_bytes(options, path), "linked": section_bytes(options, image), "ram": ram,
        "stack_loading": max(calls.depth(name) for name in loading),
        "stack_queries": max(calls.depth(name) for name in names if name not in loading),
    }  # fmt: skip


def measure_adapters(options):
    result = {}
    for form, objects in (given.split("=") for given in options.adapters):
        paths = {Path(path).name.split(".")[0]: path for path in objects.split(":")}
        ram = symbols_of(options, paths["adapter_ram"], ".bss")
        image = str(options.build / "linked")
        result[form] = {a: measure_adapter(options, paths[a], ram["ram_" + a], image) for a in ADAPTERS}
        result[form] |= {name: ram[name] for name in ("ram_card", "ram_pack")}
    return result


def measure_library(options, library):
    result = measure_uses(options, library, USES)
    if options.stack:
        image = str(options.build / "linked")
        all_packs = PACK + PACK_QUERIES + COMPACT_PACK + COMPACT_PACK_QUERIES
        others = NOTES + SAFE_HEIGHTS + SEGMENTS + PACK_CHECK + PACK_BOUNDS + REQUESTS + CLEARANCE + PROFILE + PACK_PROFILE + COMPACT_PACK_PROFILE
        others += GRADIENT + PACK_GRADIENT + PLACES + EDGE_MARKS + PACK_SEARCH + COMPACT_PACK_SEARCH
        link(options, library, DECODING + QUERIES + BUCKETS + COMPACT + others + all_packs, image)
        calls = stack_of(options, options.objects[library], image)
        own = {
            "decoding": DECODING, "queries": QUERIES, "buckets": BUCKETS, "compact": COMPACT, "pack": PACK,
            "pack_queries": PACK_QUERIES, "compact_pack": COMPACT_PACK, "compact_pack_queries": COMPACT_PACK_QUERIES,
            "notes": NOTES, "safe_heights": SAFE_HEIGHTS, "segments": SEGMENTS, "pack_check": PACK_CHECK,
            "pack_bounds": PACK_BOUNDS, "requests": REQUESTS,
            "clearance": CLEARANCE, "profile": PROFILE, "pack_profile": PACK_PROFILE,
            "compact_pack_profile": COMPACT_PACK_PROFILE, "gradient": GRADIENT, "pack_gradient": PACK_GRADIENT,
            "places": PLACES, "edge_marks": EDGE_MARKS,
            "pack_search": PACK_SEARCH, "compact_pack_search": COMPACT_PACK_SEARCH,
        }  # fmt: skip
        for use, entries in own.items():
            result["stack_" + use] = depth_of(options, calls, entries)
    return result


def run_image(options, image):
    """The numbers that an image prints, by name."""
    command = [*options.run.split(), image, *options.counting.split()]
    run = subprocess.run(command, check=True, capture_output=True, text=True)
    return {name: int(value) for name, value in map(str.split, run.stdout.splitlines())}


def measure_images(options, level):
    """Decoding of the tile in each setting, queries of the balanced one, and the most expensive step of all."""
    printed = {
        stream: run_image(options, f"{options.images}{level}.{stream}")
        for stream in ("tile_quick", "tile_balanced", "tile_dense", "wheels")
    }
    numbers = {
        f"decode_{setting}": printed[f"tile_{setting}"].pop("decode_per_vertex")
        for setting in ("quick", "balanced", "dense")
    }
    numbers |= printed["tile_balanced"]
    numbers |= run_image(options, f"{options.images}{level}.pack")
    for name in ("worst_step", "compact_worst_step"):
        numbers[name] = max(p[name] for p in printed.values())
    return numbers


def version(compiler):
    run = subprocess.run([compiler, "--version"], check=True, capture_output=True, text=True)
    return run.stdout.splitlines()[0]


def measure(options):
    result = {"compiler": version(options.compiler.split()[0])}
    for level, library in (("Os", options.Os), ("O2", options.O2)):
        result[level] = measure_library(options, library)
        if options.images:
            result[level]["run"] = measure_images(options, level)
    if options.switches:
        result["switches"] = measure_switches(options)
    if options.adapters:
        result["adapters"] = measure_adapters(options)
    if options.locks:
        result["locks"] = measure_uses(options, options.locks, LOCK_USES)
    if options.clang_object:
        result["one_source"] = {
            "clang_version": version(options.clang),
            "gcc": measure_uses(options, options.one_source, ONE_SOURCE_USES),
            "clang": measure_uses(options, options.clang_object, ONE_SOURCE_USES),
        }
    return result


def bytes_of(sizes):
    return sizes["text"] + sizes["rodata"]


def keeps_bounds(options, measured):
    """Whether the decoder in one source keeps its bounds; prints which it does not."""
    broken = []
    if options.locks:
        for use, sizes in measure_uses(options, options.locks, LOCKLESS_USES).items():
            if sizes != measured["Os"][use]:
                broken.append(f"{use}: {bytes_of(sizes)} bytes with hooks for a lock, {bytes_of(measured['Os'][use])} without")
    sizes = measured.get("one_source")
    for use in ONE_SOURCE_USES if sizes else []:
        gcc, clang = bytes_of(sizes["gcc"][use]), bytes_of(sizes["clang"][use])
        if clang > MOST_OF_CLANG * gcc:
            broken.append(f"{use}: {clang} bytes by clang, {gcc} by gcc")
    if options.images:
        separate, one = (run_image(options, f"{options.images}{kind}.tile_balanced") for kind in ("Os", "one_source"))
        for name, instructions in separate.items():
            if one[name] > MOST_OF_ONE_SOURCE * instructions:
                broken.append(f"{name}: {one[name]} in one source, {instructions} in separate ones")
    for what in broken:
        print("BEYOND ITS BOUND:", what)
    return not broken


# --- The budget -----------------------------------------------------------------------------------


def leaves(tree, path=""):
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{path}{key}.")
        else:
            yield path + key, value


def compare(target, measured):
    """Prints what differs from the budget; whether nothing is above it."""
    budget = json.loads(BUDGET.read_text()).get(target)
    if budget is None:
        print(f"skipped: there is no budget of {target}")
        return True
    allowed, found, grown = dict(leaves(budget)), dict(leaves(measured)), False
    for name in ("compiler", "one_source.clang_version"):
        if name in found and found[name] != allowed.get(name):
            print(f"skipped: the budget was recorded with {allowed.get(name)}, this is {found[name]}")
            return True
    for name, value in found.items():
        if value == allowed.get(name):
            continue
        above = name not in allowed or value > allowed[name]
        grown |= above
        print(f"{'GROWN' if above else 'shrunk'}: {name} is {value}, the budget {allowed.get(name)}")
    if grown:
        print("If that is meant: tests/footprint/record.sh")
    return not grown


# --- The documents --------------------------------------------------------------------------------


def count(number):
    return f"{number:,}"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def code_cell(numbers):
    return f"{count(numbers['text'])} + {count(numbers['rodata'])}"


USE_TITLES = {
    "decoding": "decoding",
    "queries": "decoding, queries",
    "buckets": "decoding, queries, buckets",
    "compact": "decoding, compact terrain",
    "pack": "packs, heights",
    "pack_queries": "packs, all queries",
    "compact_pack": "packs with compact slots, heights",
    "compact_pack_queries": "packs with compact slots, all queries",
    "notes": "finding notes",
    "safe_heights": "decoding, safe heights",
    "segments": "decoding, extremes on a segment",
    "pack_check": "packs, heights, checks",
    "pack_bounds": "packs, heights, bounds",
    "requests": "packs, heights, requests",
    "clearance": "decoding, clearance of a path",
    "profile": "decoding, a profile",
    "pack_profile": "packs, a profile",
    "compact_pack_profile": "packs with compact slots, a profile",
    "gradient": "decoding, gradients",
    "pack_gradient": "packs, gradients",
    "places": "decoding, many positions",
    "edge_marks": "decoding, marks of edges",
    "pack_search": "packs, search of a path",
    "compact_pack_search": "packs with compact slots, search of a path",
}
STACK_TITLES = {
    "decoding": "decoding",
    "pack": "loading tiles",
    "pack_queries": "queries of packs",
    "compact_pack": "loading tiles, compact slots",
    "compact_pack_queries": "queries of packs, compact slots",
    "notes": "finding notes",
    "safe_heights": "safe heights",
    "segments": "extremes on a segment",
    "pack_check": "checks of packs",
    "pack_bounds": "bounds of packs",
    "requests": "requests of packs",
    "clearance": "clearance of a path",
    "profile": "a profile",
    "pack_profile": "a profile through a pack",
    "compact_pack_profile": "a profile through a pack, compact slots",
    "gradient": "a gradient",
    "pack_gradient": "a gradient in a pack",
    "places": "many positions",
    "edge_marks": "marks of edges",
    "pack_search": "search of a path",
    "compact_pack_search": "search of a path, compact slots",
}


def code_table(budget, level):
    rows = [
        [target, *(code_cell(numbers[level][use]) if use in numbers[level] else "-" for use in USES)]
        for target, numbers in budget.items()
    ]
    return table(["target", *(USE_TITLES[use] for use in USES)], rows)


def stack_cell(numbers, use):
    return count(numbers["stack_" + use]) if "stack_" + use in numbers else "-"


def stack_table(budget, level):
    rows = [
        [target, *(stack_cell(numbers[level], use) for use in STACK_TITLES)]
        for target, numbers in budget.items()
        if "stack_decoding" in numbers[level]
    ]
    return table(["target", *STACK_TITLES.values()], rows)


MEAN_AND_WORST = ": mean, worst"
RUNS = {
    "How many instructions does decoding take?": {
        "decode_quick": "a vertex, coding `quick`",
        "decode_balanced": "a vertex, coding `balanced`",
        "decode_dense": "a vertex, coding `dense`",
        "worst_step": "the most expensive work unit, in a stream made for it",
    },
    "How many instructions does a height on a mesh take?": {
        "warm": "positions on a straight path" + MEAN_AND_WORST,
        "cold": "any position, from hint 0" + MEAN_AND_WORST,
        "far": "any position, from the previous hint" + MEAN_AND_WORST,
        "buckets": "any position, from 45 x 45 buckets" + MEAN_AND_WORST,
        "buckets_build": "building these buckets, once",
    },
    "How many instructions does a compact terrain take?": {
        "compact_make": "making it, a vertex",
        "compact_worst_step": "making it, the most expensive work unit",
        "compact_warm": "height on a straight path" + MEAN_AND_WORST,
        "compact_far": "height at any position, from the previous hint" + MEAN_AND_WORST,
        "compact_found": "height at any position, from microtin_compact_hint" + MEAN_AND_WORST,
    },
    "How many instructions does a segment take?": {
        "segment": "extremes between any two positions" + MEAN_AND_WORST,
        "segment_step": "the same, a triangle that it meets",
        "compact_segment": "compact terrain: extremes between any two positions" + MEAN_AND_WORST,
        "compact_segment_step": "compact terrain: the same, a triangle that it meets",
    },
    "How many instructions does a pack take?": {
        "pack_tile": "loading a tile of 64 vertices from flash",
        "pack_worst_call": "loading, the most expensive call of one work unit",
        "pack_worst_call_20": "loading, the most expensive call of 20 work units",
        "pack_height": "height anywhere in 9 tiles" + MEAN_AND_WORST,
        "pack_highest": "extremes on a segment through 9 tiles" + MEAN_AND_WORST,
        "compact_pack_tile": "compact slots: loading a tile",
        "compact_pack_worst_call": "compact slots: loading, the most expensive call",
        "compact_pack_worst_call_20": "compact slots: loading, the most expensive call of 20 work units",
        "compact_pack_height": "compact slots: height" + MEAN_AND_WORST,
        "compact_pack_highest": "compact slots: extremes on a segment" + MEAN_AND_WORST,
    },
}


def run_table(budget, titles):
    runs = {
        f"{target} -{level}": numbers[level]["run"]
        for target, numbers in budget.items()
        for level in ("Os", "O2")
        if "run" in numbers[level]
    }
    rows = []
    for name, title in titles.items():
        keys = [f"{name}_mean", f"{name}_worst"] if title.endswith(MEAN_AND_WORST) else [name]
        rows.append([title] + [", ".join(count(run[key]) if key in run else "-" for key in keys) for run in runs.values()])
    return table(["instructions", *runs], rows)


def ram_table(budget):
    run = budget["cortex-m4"]["Os"]["run"]
    rows = []
    for capacity in (250, 1000, 10000):
        kinds = ("terrain", "decoder", "compact", "narrow")
        rows.append([count(n) for n in (capacity, *(run[f"ram_{kind}_{capacity}"] for kind in kinds))])
    head = ["vertices", "mesh, kept", "decoder, only while decoding", "compact terrain", "compact terrain, less than 256 steps wide and high"]
    return table(head, rows)


def one_source_table(sizes):
    rows = [[compiler, *(code_cell(sizes[compiler][use]) for use in ONE_SOURCE_USES)] for compiler in ("gcc", "clang")]
    ratios = (bytes_of(sizes["clang"][use]) / bytes_of(sizes["gcc"][use]) for use in ONE_SOURCE_USES)
    rows.append(["clang / gcc", *(f"{ratio:.2f}" for ratio in ratios)])
    return table(["compiler", "decoding", "decoding, queries", "packs, all queries", "everything"], rows)


def switches_table(budget):
    everything = {use: budget["Os"][use] for use in SWITCH_USES} | {"stack_decoding": budget["Os"]["stack_decoding"]}
    rows = []
    for combination, sizes in ({"none": everything} | budget["switches"]).items():
        names = [f"`MICROTIN_{name.upper()}`" for name in combination.split(".")] if combination != "none" else ["none"]
        saved = bytes_of(everything["decoding"]) - bytes_of(sizes["decoding"])
        rows.append([", ".join(names), *(code_cell(sizes[use]) for use in SWITCH_USES), count(saved),
                     count(sizes["stack_decoding"])])
    head = ["switches", *(USE_TITLES[use] for use in SWITCH_USES), "bytes saved, decoding", "stack, decoding"]
    return table(head, rows)


ADAPTER_TITLES = {"inav": "INAV", "ardupilot": "ArduPilot"}
SLOT_TITLES = {"meshes": "meshes", "compact": "compact"}


def adapter_rows(numbers):
    for adapter, title in ADAPTER_TITLES.items():
        for form, slots in SLOT_TITLES.items():
            one = numbers["adapters"][form][adapter]
            yield [title, slots, code_cell(one["own"]), code_cell(one["linked"]),
                   *(count(one[name]) for name in ("ram", "stack_loading", "stack_queries"))]  # fmt: skip


ADAPTER_HEAD = ["adapter", "slots", "its own code + constants", "with decoder and helpers", "RAM, its state",
                "stack, loading", "stack, queries"]  # fmt: skip


def adapters_table(budget):
    """For all targets, and the pack's memory apart."""
    rows = [[target, *row] for target, numbers in budget.items() if "adapters" in numbers for row in adapter_rows(numbers)]
    return table(["target", *ADAPTER_HEAD], rows)


PACK_WORK = {
    "height": "a height in nine tiles: mean, worst",
    "highest": "extremes on a segment through nine tiles: mean, worst",
    "worst_call": "loading, the most expensive call of one work unit",
    "worst_call_20": "loading, the most expensive call of 20 work units",
    "tile": "loading a tile of 64 vertices from flash",
}


def autopilots_table(budget):
    """Bytes on a Cortex-M7, with the memory of the pack that the page's glue makes, and instructions."""
    forms, run = budget["cortex-m7"]["adapters"], budget["cortex-m7"]["Os"]["run"]
    rows = [[*row, count(forms[row[1]]["ram_pack"])] for row in adapter_rows(budget["cortex-m7"])]
    work = []
    for name, title in PACK_WORK.items():
        ends = ("_mean", "_worst") if title.endswith("mean, worst") else ("",)
        kinds = ("pack_", "compact_pack_")
        work.append([title, *(", ".join(count(run[kind + name + end]) for end in ends) for kind in kinds)])
    text = "Instructions on a Cortex-M7 at -Os, counted under emulation. Instructions are not cycles."
    bytes_taken = table([*ADAPTER_HEAD, "RAM, nine slots of 356 vertices"], rows)
    return f"{bytes_taken}\n{paragraph(text)}\n{table(['instructions', 'slots of meshes', 'compact slots'], work)}"


def locks_table(budget):
    rows = []
    for target, numbers in budget.items():
        if "locks" in numbers:
            pairs = [(bytes_of(numbers["Os"][use]), bytes_of(numbers["locks"][use])) for use in LOCK_USES]
            rows.append([target, *(f"{count(most - least)} of {count(least)}" for least, most in pairs)])
    return table(["target", *(USE_TITLES[use] for use in LOCK_USES)], rows)


def paragraph(text):
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def section(heading, text, rows):
    return f"## {heading}\n\n{paragraph(text)}\n{rows}"


def footprint(budget):
    """One section for each question, with one table."""
    linked = "Bytes of code + bytes of constants in a linked firmware image, the compiler's helpers included."
    stack = "Bytes of stack of the deepest call, from the static call graph. Interrupts need their own."
    emulated = "Counted under emulation for a terrain of 2,000 vertices. Instructions are not cycles."
    fits = (
        "The largest terrain on a device with 16 KB of RAM, of which the application uses 4 KB. The first number follows "
        "from the sizes of workspaces and the stack of decoding in the tables below. Decoding takes the most memory, so the "
        "number holds also for a terrain that becomes compact afterwards. The tests `microbit.kept` and `atmega1284p.kept` "
        "keep the pack of the last column under emulation, and compare 1,000 of its heights with the host's."
    )
    sections = [
        section("What fits in 16 KB of RAM?", fits, table(boards.SMALL_HEAD, boards.small_rows(budget))),
        section("How much flash does the decoder take at -Os?", linked, code_table(budget, "Os")),
        section("How much flash does the decoder take at -O2?", linked, code_table(budget, "O2")),
        section("How much stack does the decoder take at -Os?", stack, stack_table(budget, "Os")),
        section("How much stack does the decoder take at -O2?", stack, stack_table(budget, "O2")),
        section("How much RAM does a terrain take?",
                "Bytes, `sizeof` of the C++ objects on a Cortex-M with 16-bit indices. The library has no initialised and "
                "no zeroed data.", ram_table(budget)),
    ]  # fmt: skip
    sections += [section(heading, emulated, run_table(budget, titles)) for heading, titles in RUNS.items()]
    if budget["cortex-m4"].get("switches"):
        sections.append(section(
            "What does each switch save?",
            "The decoder on a Cortex-M4 at -Os, built with the switches of `config.h`. The table has bytes of code + "
            "bytes of constants, and bytes of stack.", switches_table(budget["cortex-m4"]),
        ))  # fmt: skip
    if sizes := budget["cortex-m4"].get("one_source"):
        sections.append(section(
            "Which compiler makes the smaller code?",
            "The decoder in one source (`decoder/amalgamate.py`) on a Cortex-M4 at -Os, linked alike by both compilers. "
            f"The clang is {sizes['clang_version']}; Keil's compiler is built on clang.", one_source_table(sizes),
        ))  # fmt: skip
    sections.append(section(
        "What do the adapters for autopilots take?",
        "Bytes of the adapters of `decoder/adapters` at -Os, with floating point by the compiler's helpers. Slots are those "
        "of the pack. The stack of the firmware's read callback and card driver is not counted.", adapters_table(budget),
    ))  # fmt: skip
    sections.append(section(
        "What do hooks for a lock cost?",
        "Bytes of code that `MICROTIN_PACK_ENTER` and `MICROTIN_PACK_LEAVE` add at -Os, and the bytes without them. The "
        "lock itself is not counted. Without the hooks nothing is added. With them, programs without packs keep their size: "
        "the test `footprint` compares both.", locks_table(budget),
    ))  # fmt: skip
    compilers = "; ".join(sorted({numbers["compiler"] for numbers in budget.values()}))
    sections.append("## Which compilers were used?\n\n" + paragraph(f"{compilers}."))
    return "\n".join(sections)


SHOWN = ["cortex-m0", "cortex-m4", "rv32imc", "avr"]


def summary(budget):
    """The README's table, and what fits in 16 KB of RAM."""
    head = ["target", "code + constants, decoding", "code + constants, decoding and queries", "stack, decoding"]
    head += ["instructions, decoding a vertex", "instructions, a height near the last one"]
    rows = []
    for target in SHOWN:
        numbers = budget[target]["Os"]
        row = [target] + [f"{count(numbers[u]['text'])} + {count(numbers[u]['rodata'])}" for u in ("decoding", "queries")]
        row.append(count(numbers["stack_decoding"]))
        run = numbers.get("run")
        rows.append(row + ([count(run["decode_balanced"]), count(run["warm_mean"])] if run else ["-", "-"]))
    _, mesh, pack = boards.small_rows(budget)[0]
    fits = (
        f"With 16 KB of RAM, of which the application uses 4 KB, a micro:bit holds a single mesh of {mesh} vertices, or a pack "
        f"of {pack.replace(' in ', ' vertices in ')} in compact form."
    )
    return table(head, rows) + "\n" + paragraph(fits)


def boards_table(budget):
    return table(boards.HEAD, boards.rows(budget))


DOCUMENTS = {
    ROOT / "shared/docs/sizes.md": footprint,
    ROOT / "README.md": summary,
    ROOT / "decoder/docs/boards.md": boards_table,
    ROOT / "decoder/docs/autopilots.md": autopilots_table,
}
MARKED = re.compile(r"(<!-- footprint: .* -->\n\n)(.*?)(\n<!-- end of footprint -->)", re.S)


def with_tables(document, budget):
    """The document's text with the budget's tables."""
    text, found = MARKED.subn(lambda m: m[1] + DOCUMENTS[document](budget) + m[3], document.read_text())
    if found != 1:
        sys.exit(f"{document.name} has no place for the tables, or several")
    return text


# --- Commands -------------------------------------------------------------------------------------


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("measure")
    for name in ("target", "compiler", "objdump", "Os", "O2", "Os-objects", "O2-objects"):
        one.add_argument("--" + name, required=True)
    one.add_argument("--build", required=True, type=Path)
    one.add_argument("--stack", action="store_true")
    one.add_argument("--bits", required=True, help="width of the library's numbers")
    one.add_argument("--images", help="the start of their paths: level and stream follow")
    one.add_argument("--run", help="the emulator's command")
    one.add_argument("--counting", help="its options for counting")
    one.add_argument("--switches", action="append", default=[], help="COMBINATION=LIBRARY=OBJECTS")
    one.add_argument("--adapters", action="append", default=[], help="FORM=OBJECTS")
    one.add_argument("--locks", help="the library with hooks for a lock")
    one.add_argument("--one-source", help="the library made of one source")
    one.add_argument("--clang", help="the compiler")
    one.add_argument("--clang-object", help="what it makes of that source")
    many = commands.add_parser("record")
    many.add_argument("build", nargs="*", type=Path)
    commands.add_parser("documents")
    return parser.parse_args()


def main():
    options = arguments()
    if options.command == "measure":
        options.objects = {options.O2: options.O2_objects, options.Os: options.Os_objects}
        measured = measure(options)
        (options.build / "footprint.json").write_text(json.dumps({options.target: measured}))
        within_budget = compare(options.target, measured)
        return keeps_bounds(options, measured) and within_budget
    if options.command == "record":
        budget = json.loads(BUDGET.read_text())
        for build in options.build:
            budget |= json.loads((build / "footprint.json").read_text())
        BUDGET.write_text(json.dumps(budget, indent=1) + "\n")
        for document in DOCUMENTS:
            document.write_text(with_tables(document, budget))
        return True
    budget = json.loads(BUDGET.read_text())
    others = [document.name for document in DOCUMENTS if document.read_text() != with_tables(document, budget)]
    for name in others:
        print(f"{name} does not have the budget's tables: tests/footprint/record.sh writes them.")
    return not others


sys.exit(0 if main() else 1)
