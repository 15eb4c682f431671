# SPDX-License-Identifier: MIT
"""curve.py TABLE BUDGET PLOT DOCUMENT...: draws bits against instructions per vertex, on the host from the table that `run speed`
printed of 80,000 uniform points, on Cortex-M4 from the budget of tests/footprint, and prints the same as a table, which it
puts into each document between its markers.

Draco's bits are those that `run rate` prints.
"""

import json
import re
import sys
from pathlib import Path

SETTINGS = {"quick": "_D9_quick", "balanced": "", "dense": "_D10_dense"}
PEERS = {"Draco points (level 10) + CGAL": 17.80}
COLOURS = {"quick balanced dense": "#1f6f8b", "peers": "#5a7d2a"}
MARKED = re.compile(r"(<!-- curve: .* -->\n\n).*?(\n<!-- end of curve -->)", re.S)
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 420, 320, 56, 100, 34, 48


def rows_of(text):
    """The rows of the Markdown table of decoding, by the stream's name; cells by their heads."""
    rows, head = {}, None
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[:2] == ["stream", "vertices"]:
            head = cells
        elif head and len(cells) == len(head) and not cells[0].startswith("-"):
            rows[cells[0]] = dict(zip(head, cells))
    return rows


def number(cell):
    return float(cell.replace(",", ""))


def measured(table, sizes, budget):
    """A line for each way: name, bits, instructions on the host of uniform points and of a tile, on Cortex-M4 of a tile at
    -O2 and -Os; None is not measured."""
    rows = rows_of(table)
    runs = {level: budget["cortex-m4"][level]["run"] for level in ("O2", "Os")}
    host = lambda stream, way="microtin": number(rows[stream][way]) if stream in rows else None
    lines = []
    for setting, suffix in SETTINGS.items():
        row = rows["2_uniform_80k" + suffix]
        bits = 8 * sizes[row["stream"]] / number(row["vertices"])
        device = [runs[level]["decode_" + setting] for level in ("O2", "Os")]
        lines.append((setting, bits, host(row["stream"]), host("tile_" + setting), *device))
    for name, bits in PEERS.items():
        if name in rows["2_uniform_80k"]:
            lines.append((name, bits, host("2_uniform_80k", name), host("tile_balanced", name), None, None))
    return lines


def panel(lines, column, left, title):
    """One plot, as SVG: instructions from 0 to the right, bits upwards."""
    shown = [(name, line[0], line[column]) for name, *line in lines if line[column]]
    most = max(x for _, _, x in shown) * 1.12
    low, high = 17.7, 18.4
    place = lambda x, y: (
        left + LEFT + x / most * (WIDTH - LEFT - RIGHT),
        TOP + (high - y) / (high - low) * (HEIGHT - TOP - BOTTOM),
    )
    out = [f"<text x='{left + WIDTH / 2:.0f}' y='20' text-anchor='middle'>{title}</text>"]
    for y in (17.8, 18.0, 18.2):
        x0, at = place(0, y)
        out.append(f"<path d='M{x0:.0f} {at:.1f}H{left + WIDTH - RIGHT}' stroke='#ddd'/>")
        out.append(f"<text x='{x0 - 6:.0f}' y='{at + 4:.1f}' text-anchor='end'>{y}</text>")
    for x in range(0, int(most), 2000 if most < 11000 else 4000):
        at, y0 = place(x, low)
        out.append(f"<path d='M{at:.1f} {TOP}V{y0:.1f}' stroke='#eee'/>")
        out.append(f"<text x='{at:.1f}' y='{y0 + 16:.1f}' text-anchor='middle'>{x:,}</text>")
    for group, colour in COLOURS.items():
        points = [p for p in shown if group_of(p[0]) == group]
        path = "L".join("{:.1f} {:.1f}".format(*place(x, y)) for _, y, x in points)
        if points:
            out.append(f"<path fill='none' stroke-width='2' stroke='{colour}' d='M{path}'/>")
        last = None
        for name, y, x in points:
            cx, cy = place(x, y)
            near = last is not None and abs(cx - last[0]) < 60 and abs(cy - last[1]) < 14
            near = near or group == "peers"  # its label goes below
            last = cx, cy
            out.append(f"<circle r='4' cx='{cx:.1f}' cy='{cy:.1f}' fill='{colour}'/>")
            out.append(f"<text x='{cx + 7:.1f}' y='{cy + (14 if near else -5):.1f}' fill='{colour}'>{name}</text>")
    return out


def group_of(name):
    return "peers" if name in PEERS else "quick balanced dense"


def table_of(lines):
    heads = ["coding", "bits per vertex, uniform points", "x86-64, uniform points", "x86-64, tile"]
    heads += ["Cortex-M4 -O2, tile", "Cortex-M4 -Os, tile"]
    out = [f"| {' | '.join(heads)} |", "| --- " * len(heads) + "|"]
    for name, bits, *costs in lines:
        cells = [name, f"{bits:.2f}", *(f"{cost:,.0f}" if cost else "-" for cost in costs)]
        out.append(f"| {' | '.join(cells)} |")
    return "\n".join(out) + "\n"


def put_into(document, table):
    text, found = MARKED.subn(lambda m: m[1] + table + m[2], Path(document).read_text())
    if found != 1:
        sys.exit(f"{document} has no place for the table, or several")
    Path(document).write_text(text)


def main(table, budget, plot, *documents):
    text = Path(table).read_text()
    streams = Path(table).parent / "streams"
    sizes = {path.stem: path.stat().st_size for path in streams.glob("*.mtin")}
    lines = measured(text, sizes, json.loads(Path(budget).read_text()))
    titles = [(1, "x86-64, 80,000 uniform points"), (3, "Cortex-M4 -O2, a tile"), (4, "Cortex-M4 -Os, a tile")]
    out = [
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{3 * WIDTH}' height='{HEIGHT}' "
        "font-family='sans-serif' font-size='12' fill='#333'>",
        "<rect width='100%' height='100%' fill='white'/>",
    ]
    for i, (column, title) in enumerate(titles):
        out += panel(lines, column, i * WIDTH, title)
    caption = "bits of a uniform point against instructions per vertex"
    out.append(f"<text x='{1.5 * WIDTH}' y='{HEIGHT - 10}' text-anchor='middle'>{caption}</text></svg>")
    Path(plot).write_text("\n".join(out) + "\n")
    for document in documents:
        put_into(document, table_of(lines))
    print("\n### Bits against instructions per vertex\n\n" + table_of(lines))


main(*sys.argv[1:])
