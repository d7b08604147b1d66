"""The report as one HTML page with embedded pictures, plots, style and script, which opens without a server."""
import base64
import html
import logging
import math
import os
import pathlib
import pkgutil

import matplotlib
from matplotlib import figure

from answers import answers
from rows import REGIONS, STAGES, Verdict, cells, fixed, ray_tracing_curves, significant

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it tells that it looks for fonts
matplotlib.rcParams["svg.hashsalt"] = "report"  # the same plot is the same file

IN_USE = ["distributed ray tracing", "denoised ray tracing", "centre + 4, lens normal", "accumulated lens views",
          "one view, lens normal", "centre + 4 denoised, lens normal", "centre + 4 planned, lens normal",
          "centre + 8, lens normal"]
COLOURS = ["#4477aa", "#66ccee", "#228833", "#ccbb44", "#aa3377", "#bbbbbb", "#885522"]
MARKERS, DASHES = "s^vDo<>pP*X", ["-", "--", ":", "-."]
TITLE = "Depth of field: error against time"
TEXT = """Seconds are wall time, rendering included; rays are camera samples a pixel, all views together, since a
production shader costs more than a test scene's. dB is PSNR of tone-mapped pixels against the reference, <i>worst</i>
that of the worst 1 % of blocks of 8 x 8 pixels. FLIP is what somebody sees who flips between the two at the worst of
several exposures, 0 to 1. <i>Sampling</i> is the picture against the same layers seen through many lens points,
<i>layers</i> is that picture against the reference: what the layers lack. <i>Equal error</i> is what distributed ray
tracing takes for a row's error, as a multiple of the row's time and in rays; &lt; and &gt; are bounds where its
measured budgets end. <i>Equal time</i> is how much better the row is than ray tracing of the same time; nothing where
none so short or so long was measured. <i>Pull</i> is a pull of focus to 1.1 times its distance in 16 frames: the
pixels whose second difference over time exceeds 0.02 (flicker) and 0.05 (sparkle), and the largest."""
CONTROLS = """<label>show <select class="mode"><option value="slide">slide</option><option value="flip">flip</option>
<option value="difference">difference x 8</option></select></label> <label>zoom <select class="zoom"><option>1</option>
<option>2</option><option>4</option><option>8</option></select></label>
<label>slider <input class="slider" type="range" min="0" max="100" value="50"></label></div><div class="frame">
<div class="stack"><img class="below" alt="right picture"><img class="above" alt="left picture"></div></div>
"""


def rows_in_use(rows):
    """The rows of the most important ways, six at most. Ways that only the literature has are left out."""
    used = [name for name in IN_USE if any(row.method == name for row in rows)][:6]
    return [row for row in rows if row.method in used]


def draw(rows, kind):
    """Error against "seconds" or "rays" with logarithmic axes and one line per method. The error is the root mean
    square of tone-mapped differences, 10^(-dB / 20); the right axis has dB. Equal pictures have none: left out."""
    drawn = figure.Figure((10, 5.6), dpi=100, layout="constrained")
    label = "seconds, rendering included" if kind == "seconds" else "camera samples a pixel, all views together"
    axes = drawn.add_subplot(xscale="log", yscale="log", xlabel=label, ylabel="root mean square error, tone-mapped",
                             title=f"{rows[0].title}: error against {kind}" if rows else "")
    known = [row for row in rows if math.isfinite(row.quality)]
    for number, method in enumerate(dict.fromkeys(row.method for row in rows)):
        role = next(row.role for row in rows if row.method == method)
        points = [(row.total if kind == "seconds" else row.rays, 10 ** (-row.quality / 20))
                  for row in sorted(known, key=lambda row: row.total) if row.method == method and row.total > 0]
        style = {"marker": MARKERS[number % len(MARKERS)], "color": COLOURS[number % len(COLOURS)], "linewidth": 1}
        style |= {"sparse": {"color": "#ee3311", "linewidth": 2, "linestyle": DASHES[number % len(DASHES)]},
                  "traced": {"color": "black", "linewidth": 2.5, "marker": "o"}}.get(role, {})
        axes.plot(*zip(*points) if points else ([], []), label=method.replace("$", r"\$"), markersize=4, **style)
    if known:
        low, high = (5 * bound((end(row.quality for row in known) + more) / 5)
                     for bound, end, more in ((math.floor, min, -0.5), (math.ceil, max, 0.5)))
        axes.set_ylim(10 ** (-high / 20), 10 ** (-low / 20))
        # Decibels are linear where the error is logarithmic, so the right axis is aligned with the left one.
        decibels = axes.twinx()
        decibels.set(ylabel="PSNR, dB", ylim=(high, low), yticks=range(low, high + 1, 5))
        decibels.grid(axis="y", color="#dddddd")
        axes.set_zorder(decibels.get_zorder() + 1)  # lines lie over the grid
        axes.patch.set_visible(False)
        axes.legend(loc="upper left", bbox_to_anchor=(1.1, 1), fontsize=9, frameon=False)
    axes.grid(axis="x", color="#dddddd")
    return drawn


def draw_plots(folder, rows, name):
    """Writes NAME-seconds and NAME-rays as SVG and PNG, and returns the SVG files."""
    os.makedirs(folder, exist_ok=True)
    for kind in "seconds", "rays":
        drawn = draw(rows, kind)
        drawn.savefig(f"{folder}/{name}-{kind}.png")
        drawn.savefig(f"{folder}/{name}-{kind}.svg", metadata={"Date": None})
    return [pathlib.Path(f"{folder}/{name}-{kind}.svg").read_bytes() for kind in ("seconds", "rays")]


def element(tag, *texts):
    return "".join(f"<{tag}>{html.escape(text)}</{tag.split()[0]}>\n" for text in texts)


def image(kind, data, words):
    return f'<img {words} src="data:image/{kind};base64,{base64.b64encode(data).decode()}">\n'


def viewer(pictures):
    """Shows one picture left of the slider and another right of it; page.js moves, flips, subtracts and zooms."""
    def choice(side, chosen):
        options = "".join(element(f'option value="{k}"' + (" selected" if k == chosen else ""), title)
                          for k, (title, _) in enumerate(pictures))
        return f'<label>{side} <select class="{side}">\n{options}</select></label>\n'
    images = "".join(image("png", png, f'alt="{html.escape(title)}"') for title, png in pictures)
    choices = choice("left", min(1, len(pictures) - 1)) + choice("right", 0)
    return (f'<div class="viewer">\n<div class="controls">\n{choices}{CONTROLS}<div class="pictures" hidden>\n{images}'
            '</div></div>\n') if pictures else ""


def table(rows):
    curves = ray_tracing_curves(rows)
    text = '<div class="wide"><table>\n<thead><tr>\n' + element(
        "th", "renderer", "processor", "budget", "rays", "seconds", *STAGES, "peak MB", "dB",
        *(name + " dB" for name in REGIONS), "worst dB", "FLIP", "SSIM", "sampling dB", "layers dB", "pull: flicker",
        "pull: sparkle", "pull: largest", "equal error: times longer", "equal error: rays", "equal time: dB better",
        "not finite") + "</tr></thead>\n<tbody>\n"
    for row in rows:
        costs, figures = cells(row, curves)
        stages = [significant(seconds, 3) if seconds > 0 else "" for seconds in row.seconds]
        text += (f'<tr class="{row.role}">\n' if row.role else "<tr>\n") + element(
            "td", row.renderer, row.processor, row.budget) + element(
                'td class="n"', *costs, *stages, *figures, fixed(row.errors[0]["nonfinite_image"], 0)) + "</tr>\n"
    return text + "</tbody></table></div>\n"


def answers_table(scenes):
    found = answers(scenes)
    titles = element("th", "the question", "where that is better than five views", "where five views are")
    lines = "".join(f"<tr>\n{element('td', *line)}</tr>\n" for line in found)
    return (f'<table class="answers">\n<thead><tr>\n{titles}</tr></thead>\n<tbody>\n{lines}</tbody></table>\n'
            if found else "")


def section(scene):
    plots, more = ("".join(image("svg+xml", svg, 'class="plot" alt="error against cost"') for svg in scene[name])
                   for name in ("plots", "more_plots"))
    worst = "".join("<figure>" + image("png", png, 'alt="worst block"') + element("figcaption", title) + "</figure>\n"
                    for title, png in scene["worst"])
    title = element("h3", "The worst places: the row on the left, the reference on the right")
    summary = element("summary", "Plots of every way that was measured")
    return (f'<section>\n{element("h2", scene["rows"][0].title)}<ul class="verdict">\n'
            f'{element("li", *scene["sentences"])}</ul>\n{viewer(scene["pictures"])}{plots}'
            + (f"<details>\n{summary}{more}</details>\n" if more else "")
            + (f'{title}<div class="blocks">\n{worst}</div>\n' if worst else "")
            + f'{table(scene["rows"])}</section>\n')


def page_as_html(facts, scenes):
    """Each scene has: rows; sentences, the verdict; plots and more_plots, SVG files of the ways in use and of all;
    pictures and worst, pairs (title, PNG file). The first picture is the reference, the second is shown beside it."""
    style, script = ("".join(pkgutil.get_data("page", name).decode() for name in names)
                     for names in (["page.css", "compare.css"], ["compare.js", "page.js"]))
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{TITLE}</title>\n<style>\n'
            f'{style}</style>\n</head>\n<body>\n<h1>{TITLE}</h1>\n' + element('p class="fact"', *facts) +
            f'{answers_table([scene["rows"] for scene in scenes])}<p>{TEXT}</p>\n{"".join(map(section, scenes))}'
            f'<script>\n{script}</script>\n</body>\n</html>\n')


def scene_of_page(folder, rows, reference):
    """What page_as_html() needs of a measured scene. Its pictures are the reference, the best of the sparse views, then
    the fastest and the best of each method."""
    verdict = Verdict(rows)
    shown = [verdict.best] if verdict.best else []
    for method in sorted({row.method for row in rows}):
        those = [row for row in rows if row.method == method]
        shown += min(those, key=lambda row: row.total), max(those, key=lambda row: row.quality)
    used, plots = rows_in_use(rows), os.path.join(folder, "plots")
    files = {row.shown: f"{row.method}, {row.budget}: {fixed(row.quality, 2)} dB, {significant(row.total, 3)} s"
             for row in shown}
    pictures = {reference: "reference"} | files
    worst = {row.worst: f"{row.method}, {row.budget}: {fixed(row.errors[0]['psnr_worst'], 1)} dB" for row in used}
    return {"rows": rows, "sentences": verdict.sentences(), "plots": draw_plots(plots, used, rows[0].scene),
            "more_plots": draw_plots(plots, rows, rows[0].scene + "-all"),
            **{name: [(title, pathlib.Path(folder, file).read_bytes()) for file, title in those.items()]
               for name, those in (("pictures", pictures), ("worst", worst))}}
