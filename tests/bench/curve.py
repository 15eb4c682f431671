# SPDX-License-Identifier: MIT
"""curve.py TABLE BUDGET PLOT: draws bits against instructions per vertex, on the host from the table that `run speed`
printed of 80,000 uniform points, on Cortex-M4 from the budget of tests/footprint, and prints the same as a table.

Version 4 and Draco's bits are quoted: the former is no longer in the sources, the latter is what `run rate` prints.
"""

import json
import sys
from pathlib import Path

SETTINGS = {"quick": "_D10_quick", "balanced": "", "dense": "_D10_dense"}
VERSION_4 = {  # levels: bits, host, Cortex-M4 -O2, -Os
    "version 4, 1": (18.55, 5217, 8752, 11547),
    "version 4, 2": (18.02, 6746, 11422, 14735),
    "version 4, 3": (17.90, 8129, 12134, 15571),
}
PEERS = {"Draco points (level 10) + CGAL": 17.80}
COLOURS = {"quick balanced dense": "#1f6f8b", "version 4": "#c0562b", "peers": "#5a7d2a"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 420, 320, 56, 34, 48


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
    """A line for each way: name, bits, instructions on the host, on Cortex-M4 at -O2 and -Os; None is not measured."""
    rows = rows_of(table)
    runs = {level: budget["cortex-m4"][level]["run"] for level in ("O2", "Os")}
    lines = []
    for setting, suffix in SETTINGS.items():
        row = rows["2_uniform_80k" + suffix]
        bits = 8 * sizes[row["stream"]] / number(row["vertices"])
        device = [runs[level]["decode_" + setting] for level in ("O2", "Os")]
        lines.append((setting, bits, number(row["microtin"]), *device))
    lines += [(name, *values) for name, values in VERSION_4.items()]
    peers = rows["2_uniform_80k"]
    return lines + [(name, bits, number(peers[name]), None, None) for name, bits in PEERS.items() if name in peers]


def panel(lines, column, left, title):
    """One plot, as SVG: instructions from 0 to the right, bits upwards."""
    shown = [(name, line[0], line[column]) for name, *line in lines if line[column]]
    most = max(x for _, _, x in shown) * 1.12
    low, high = 17.7, 18.65
    place = lambda x, y: (
        left + LEFT + x / most * (WIDTH - LEFT - 20),
        TOP + (high - y) / (high - low) * (HEIGHT - TOP - BOTTOM),
    )
    out = [f"<text x='{left + WIDTH / 2:.0f}' y='20' text-anchor='middle'>{title}</text>"]
    for y in (17.8, 18.0, 18.2, 18.4, 18.6):
        x0, at = place(0, y)
        out.append(f"<path d='M{x0:.0f} {at:.1f}H{left + WIDTH - 20}' stroke='#ddd'/>")
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
        for name, y, x in points:
            cx, cy = place(x, y)
            out.append(f"<circle r='4' cx='{cx:.1f}' cy='{cy:.1f}' fill='{colour}'/>")
            out.append(f"<text x='{cx + 7:.1f}' y='{cy - 5:.1f}' fill='{colour}'>{name}</text>")
    return out


def group_of(name):
    if name in PEERS:
        return "peers"
    return "version 4" if name.startswith("version 4") else "quick balanced dense"


def main(table, budget, plot):
    text = Path(table).read_text()
    streams = Path(table).parent / "streams"
    sizes = {path.stem: path.stat().st_size for path in streams.glob("*.mtin")}
    lines = measured(text, sizes, json.loads(Path(budget).read_text()))
    titles = ["x86-64, 80,000 uniform points", "Cortex-M4 -O2, a tile", "Cortex-M4 -Os, a tile"]
    out = [
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{3 * WIDTH}' height='{HEIGHT}' "
        "font-family='sans-serif' font-size='12' fill='#333'>",
        "<rect width='100%' height='100%' fill='white'/>",
    ]
    for i, title in enumerate(titles):
        out += panel(lines, i + 1, i * WIDTH, title)
    caption = "bits of a uniform point against instructions per vertex"
    out.append(f"<text x='{1.5 * WIDTH}' y='{HEIGHT - 10}' text-anchor='middle'>{caption}</text></svg>")
    Path(plot).write_text("\n".join(out) + "\n")
    print("\n### Bits against instructions per vertex\n")
    print("| | bits of a uniform point | host | Cortex-M4 -O2 | -Os |\n| --- | --- | --- | --- | --- |")
    for name, bits, *costs in lines:
        cells = [f"{cost:,.0f}" if cost else "-" for cost in costs]
        print(f"| {name} | {bits:.2f} | {' | '.join(cells)} |")


main(*sys.argv[1:])
