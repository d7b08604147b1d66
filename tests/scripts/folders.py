#!/usr/bin/python3
"""The map of the folders, docs/folders.svg: tests/scripts/folders.py >docs/folders.svg

A box is a folder of src, or all of tools, plugins or lab, and lies above all boxes whose files it includes. Lines show
these includes, without those that follow from others. Thick arrows show the way from views to a picture.
"""
import os
import pathlib
import re
from html import escape
from textwrap import wrap

# Where each box stands in its row, pixels, and what it has.
BOXES = {"lab": (780, "ray tracer, references"), "plugins": (120, "OpenFX, OpenImageIO; they talk to dof-view"),
         "src/sparselens.h": (340, "the C++ library"), "src/python": (560, "the Python module"),
         "tools": (780, "command-line tools, dof-view"), "src/chain": (450, "from a request to a result"),
         "src/match": (110, "the lens of a plate"), "src/gpu": (628, "Vulkan devices"),
         "src/measure": (800, "error of a picture"), "src/io": (184, "files: EXR, USD, pictures, cameras"),
         "src/denoised": (361, "noisy and denoised views"), "src/warp": (538, "views merged into an LDI"),
         "src/dof": (715, "gathers: what each lens point sees"), "src/plan": (130, "which views to render"),
         "src/finish": (310, "pictures combined with rays"), "src/deep": (490, "the LDI and its algebra"),
         "src/shutter": (720, "moments of a shutter"), "src/view": (310, "cameras, projections, depths"),
         "src/looks": (310, "looks of a lens"), "src/lens": (450, "rays, lens points, discs"),
         "src/base": (590, "images, grids, text, threads"), "src/kernels": (310, "rules of CPU and GPU")}
FLOW = [("views", "src/io"), ("src/io", "src/denoised"), ("src/denoised", "src/warp"), ("src/warp", "src/dof"),
        ("src/dof", "picture")]
LABELS = {("src/io", "src/denoised"): "views", ("src/denoised", "src/warp"): "views", ("src/warp", "src/dof"): "LDI"}
WIDTH, ROW, HEIGHT, BOX = 900, 84, 48, 138


def box_of(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "src" else parts[0]


def includes():
    """Pairs of boxes of which the first includes the second; and all boxes."""
    found = (str(path) for top in ("src", "tools", "plugins", "lab") for path in pathlib.Path(top).rglob("*"))
    files = {path for path in found if re.search(r"\.(c|h|cpp|cpp\.in)$", path) and
             not path.startswith("lab/tests/") and not path.endswith("tuning.h")}
    pairs = set()
    for path in sorted(files):
        with open(path, encoding="utf-8") as file:
            for name in re.findall(r'^#include "([^"]*)"', file.read(), re.M):
                beside = os.path.normpath(os.path.join(os.path.dirname(path), name))
                found = next((f for f in (beside, "tools/" + name, "src/" + name, name) if f in files), path)
                pairs.add((box_of(path), box_of(found)))
    return {pair for pair in pairs if pair[0] != pair[1]}, sorted({box_of(path) for path in files})


def below(pairs, box):
    """All boxes that a box includes, and those that these include."""
    found, todo = set(), [box]
    while todo:
        direct = {lower for upper, lower in pairs if upper == todo[0]} - found
        found |= direct
        todo = todo[1:] + sorted(direct)
    return found


def levels(pairs, boxes):
    """The row of each box, 0 at the bottom: as low as its includes allow, or just below its lowest user."""
    level, way = {"plugins": 0}, {box for pair in FLOW for box in pair}
    while len(level) < len(boxes):
        for box in set(boxes) - set(level):
            lower = [b for a, b in pairs if a == box]
            if all(b in level for b in lower):
                level[box] = 1 + max((level[b] for b in lower), default=-1)
    for box in sorted(boxes, key=lambda box: -level[box]):
        users = [level[a] for a, b in pairs if b == box]
        if users and box not in way:
            level[box] = min(users) - 1
    level["plugins"] = level["tools"]  # they include nothing of sparselens
    return level


def line(x0, y0, x1, y1):
    """From a box to a lower one; past many rows along the border."""
    if y1 - y0 <= 3 * ROW:
        return f'<path class="use" d="M{x0} {y0 + HEIGHT // 2}L{x1} {y1 - HEIGHT // 2}"/>'
    side, border = (-BOX // 2, 6) if x0 < WIDTH // 2 else (BOX // 2, WIDTH - 6)
    return f'<path class="use" d="M{x0 + side} {y0}H{border}V{y1}H{x1 + side}"/>'


def arrow(x0, y0, x1, y1, label=""):
    return [f'<line class="flow" x1="{x0}" y1="{y0}" x2="{x1}" y2="{y1}" marker-end="url(#head)"/>',
            f'<text class="label" x="{(x0 + x1) // 2 - 3}" y="{y0 - 8}">{label}</text>']


def svg():
    pairs, boxes = includes()
    assert set(boxes) == set(BOXES), f"BOXES: {sorted(set(boxes) ^ set(BOXES))}"
    level = levels(pairs, boxes)
    height = ROW * (1 + max(level.values()))
    place = {box: (BOXES[box][0], height - ROW * level[box] - ROW // 2) for box in boxes}
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" font-family="sans-serif">',
           '<style>.box{fill:#f4f4f0;stroke:#666}.use{stroke:#aaa;fill:none}.flow{stroke:#c60;stroke-width:4}'
           '.on{fill:#fff0dd;stroke:#c60}.name{font-weight:bold;font-size:13px}.note{font-size:11px}'
           '.label{font-size:11px;fill:#a40}text{text-anchor:middle}</style>',
           '<defs><marker id="head" viewBox="0 0 6 6" refX="5" refY="3" markerWidth="3" markerHeight="3" orient="auto">'
           '<path d="M0 0 6 3 0 6z" fill="#c60"/></marker></defs>',
           f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>']
    for upper, lower in sorted(pairs):
        if not any(lower in below(pairs, b) for a, b in pairs if a == upper and b != lower):
            out.append(line(*place[upper], *place[lower]))
    y = place["src/warp"][1]
    place["views"], place["picture"] = (40, y), (WIDTH - 40, y)
    half = {box: BOX // 2 for box in boxes} | {"views": 26, "picture": 30}
    for start, end in FLOW:
        out += arrow(place[start][0] + half[start], y, place[end][0] - half[end], y, LABELS.get((start, end), ""))
    way = {box for pair in FLOW for box in pair}
    for box, (x, y) in place.items():
        if box not in BOXES:
            out.append(f'<text class="name" x="{x}" y="{y + 5}">{box}</text>')
            continue
        out.append(f'<rect class="box{" on" if box in way else ""}" x="{x - BOX // 2}" y="{y - HEIGHT // 2}" '
                   f'width="{BOX}" height="{HEIGHT}" rx="4"/>')
        out.append(f'<text class="name" x="{x}" y="{y - 7}">{box}</text>')
        out += [f'<text class="note" x="{x}" y="{y + 7 + 12 * i}">{escape(words)}</text>'
                for i, words in enumerate(wrap(BOXES[box][1], 23))]
    return "\n".join(out + ["</svg>"])


if __name__ == "__main__":
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
    print(svg())
