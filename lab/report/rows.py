"""The rows of a report: one for each scene, way of making depth of field, and budget; how a row compares with ray
tracing; and the verdict on the rows of a scene.

The quality of ray tracing over its cost (seconds, or rays per pixel) is a measured curve: sorted pairs (cost, dB).
Between neighbours dB is linear in the logarithm of the cost, as for plain Monte Carlo: twice the samples halve the mean
square error, 3 dB. The curve is never extrapolated.
"""
import bisect
import csv
import dataclasses
import io
import math

STAGES = ["render", "plan", "warp", "cluster", "process"]
REGIONS = ["in_focus", "blurred", "silhouettes"]
FIGURES = ["psnr", "psnr_tonemapped", "psnr_srgb", "psnr_worst", "relmse", "smape", "ssim", "ssim_srgb", "p99",
           "max", "max_alpha", "flip", "pixels", "nonfinite_image", "nonfinite_reference"]  # of dof-compare; FLIP is apart


@dataclasses.dataclass
class Rendered:
    """Pictures to make depth of field from, or the final picture of a renderer that makes it itself."""
    folder: str = ""  # for files made from it, inside the report's folder
    picture: str = ""  # the centre view, deep layers, or the final picture
    rays: float = 0  # camera samples per pixel, all views together
    rim: list = ()  # words for ldi-warp: ["view.exr"], or ["--view", "X,Y", "view.exr"]
    steps: list = ()  # that made it
    seconds: list = (0,) * len(STAGES)  # wall time of each stage, without the steps
    views: int = 1
    partial_samples: int = 0  # above 0: rim views are partial, with this many samples in each covered pixel
    supersample: int = 1  # the width of views over the width of the picture
    pull: list = ()  # frames of a focus pull, made the same way


@dataclasses.dataclass
class Row(Rendered):
    """A picture with depth of field; `seconds` and `rays` are complete when it is measured."""
    scene: str = ""
    renderer: str = ""
    processor: str = ""
    budget: str = ""  # of the renderer: "16 samples"
    role: str = ""  # "sparse": sparse views seen through each point of the lens; "traced": rays over the lens
    many_points: str = ""  # the same layers seen through many lens points
    # What is measured.
    runs: int = 0  # the times are medians of so many runs; 0: they came with the pictures
    peak_mb: float = 0  # memory of the largest process, MiB
    size: str = ""
    # Figures of the whole picture and of each region.
    errors: list = dataclasses.field(default_factory=lambda: [dict.fromkeys(FIGURES, math.nan) for _ in range(4)])
    causes: list = ()  # dB against the same layers seen through many lens points, and of these against the reference
    unsteady: list = ()  # pixels that flicker in the pull, that sparkle, and the largest second difference
    shown: str = ""  # PNG files
    difference: str = ""
    worst: str = ""

    total = property(lambda self: sum(self.seconds))
    quality = property(lambda self: self.errors[0]["psnr_tonemapped"])
    method = property(lambda self: self.renderer + (self.processor and ", " + self.processor))
    title = property(lambda self: self.scene + (self.size and ", " + self.size))
    at = property(lambda self: f"{self.method} at {self.budget}")
    figures = property(lambda self: f"{fixed(self.quality, 2)} dB in {significant(self.total, 3)} s, "
                                    f"{significant(self.rays, 4)} rays a pixel")


def fixed(value, decimals):
    return "-" if math.isnan(value) else f"{value:.{decimals}f}"


def significant(value, digits):
    return "-" if math.isnan(value) else f"{value:.{digits}g}"


def shortest(value):
    """The fewest digits that read back as the same value; "" for NaN and None."""
    return "" if value is None or math.isnan(value) else repr(float(value)).removesuffix(".0")


def curve_of(points):
    """Keeps the best of several points at one cost, and drops points that are not finite or have no cost."""
    return sorted(dict(sorted(p for p in points if 0 < p[0] < math.inf and math.isfinite(p[1]))).items())


def quality_at(curve, cost):
    """The quality at that cost, or None outside the measured costs."""
    at = bisect.bisect_left(curve, (cost,))
    if at < len(curve) and curve[at][0] == cost:
        return curve[at][1]
    if at in (0, len(curve)):
        return None
    (before, low), (after, high) = curve[at - 1:at + 1]
    return low + math.log(cost / before) / math.log(after / before) * (high - low)


def reached_at(curve, quality):
    """The cost at which the curve first reaches the quality: ("", cost); ("<", cost) if its first point has it already;
    (">", largest cost) if none has it. None without a curve."""
    before = None
    for cost, reached in curve:
        if reached >= quality:
            if before is None or reached == quality:
                return "" if reached == quality else "<", cost
            return "", before * (cost / before) ** ((quality - low) / (reached - low))
        before, low = cost, reached
    return (">", curve[-1][0]) if curve else None


def reached_text(reached, scale=1):
    return "-" if reached is None else f"{reached[0]} {significant(reached[1] / scale, 3)}".strip()


def ray_tracing_curves(rows):
    """The quality of distributed ray tracing by seconds and by rays."""
    traced = [row for row in rows if row.role == "traced"]
    return curve_of((row.total, row.quality) for row in traced), curve_of((row.rays, row.quality) for row in traced)


def compared(row, curves):
    """The seconds and the rays with which ray tracing reaches the row's error, and the dB by which the row is better in
    the same time, or None."""
    theirs = quality_at(curves[0], row.total)
    gained = None if theirs is None else row.quality - theirs
    return reached_at(curves[0], row.quality), reached_at(curves[1], row.quality), gained


class Verdict:
    """best: the sparse lens row of least error, or None; seconds, rays: where ray tracing reaches it; slower: sparse
    lens rows worse than ray tracing of the same time; below: those that are faster than the crossing, beyond which ray
    tracing is the better choice; beaten: (one of those, the best row of another kind that beats it, how many more)."""

    def __init__(self, rows):
        ours = [row for row in rows if row.role == "sparse"]
        curves = ray_tracing_curves(rows)
        self.best = max(ours, key=lambda row: row.quality, default=None)
        self.seconds, self.rays, _ = compared(self.best, curves) if ours else (None, None, None)
        self.slower = [row for row in ours if (compared(row, curves)[2] or 0) < 0]
        self.is_crossed = self.seconds is not None and self.seconds[0] == ""
        self.below = [row for row in ours if not self.is_crossed or row.total < self.seconds[1]]
        # Others that are no slower and no worse, and better in one of the two.
        better = [(row, [other for other in rows if other.role != "sparse" and other.total <= row.total and
                         other.quality >= row.quality and (other.total, other.quality) != (row.total, row.quality)])
                  for row in self.below]
        self.beaten = [(row, max(others, key=lambda other: other.quality), len(others) - 1)
                       for row, others in better if others]

    def crossing(self):
        if self.seconds is None:
            return "No ray tracing of the lens was measured."
        both = f"{significant(self.seconds[1], 3)} s, {significant(self.rays[1], 3)} rays a pixel"
        longer = ", which is less time than it takes itself: which of the two is better there was not measured."
        return "Ray tracing the lens " + {
            "": f"passes it at {both}: for less error than that, ray tracing the lens is the better choice.",
            "<": f"is better from its smallest measured budget on ({both}): it is the better choice here.",
            ">": f"does not reach it with the largest measured budget ({both})"
                 + (longer if self.best.total > self.seconds[1] else ".")}[self.seconds[0]]

    def sentences(self):
        if self.best is None:
            return ["No sparse views seen through the lens were measured."]
        text = [f"Least error of sparse views: {self.best.at}, {self.best.figures}.", self.crossing()]
        if self.slower:
            text.append("For the time of these, ray tracing the lens has less error and is the better choice: "
                        + "; ".join(row.at for row in self.slower) + ".")
        for row, by, others in self.beaten:
            more = ["", ", as is another row"][others] if others < 2 else f", as are {others} other rows"
            text.append(f"{row.at} ({row.figures}) is a poor choice: {by.at} ({by.figures}) is no slower and no "
                        f"worse{more}.")
        if not self.below:
            text.append("No sparse row with the lens gather takes less time than that.")
        elif not self.beaten:
            text.append(("In less time than that, no" if self.is_crossed else "No")
                        + " other system measured is both faster and better than any sparse row with the lens gather.")
        return text


def cells(row, curves):
    """The cells of a row that the terminal and the page have in common: rays, seconds; and memory and all figures."""
    whole = row.errors[0]
    text = [fixed(row.peak_mb, 0) if row.runs > 0 else "", *(fixed(e["psnr_tonemapped"], 2) for e in row.errors),
            fixed(whole["psnr_worst"], 2), fixed(whole["flip"], 4), fixed(whole["ssim"], 4)]
    text += [fixed(cause, 2) for cause in row.causes] or [""] * 2
    text += [*map(str, row.unsteady[:2]), fixed(row.unsteady[2], 2)] if row.unsteady else [""] * 3
    seconds, rays, gained = compared(row, curves)
    text += [""] * 3 if row.role == "traced" or row.total <= 0 else [
        reached_text(seconds, row.total), reached_text(rays), "" if gained is None else fixed(gained, 2)]
    return [significant(row.rays, 4), significant(row.total, 3)], text


def summary(rows):
    """The report of one scene for a terminal: a table and the verdict."""
    if not rows:
        return ""
    curves = ray_tracing_curves(rows)
    table = [["method", "budget", "rays", "seconds", "MB", "dB", "focus", "blurred", "silhouettes", "worst", "FLIP",
              "SSIM", "sampling", "layers", "flicker", "sparkle", "largest", "x time", "rays needed", "dB gained"]]
    table += [[row.method, row.budget, *sum(cells(row, curves), [])] for row in rows]
    widths = [max(map(len, column)) for column in zip(*table)]
    lines = ["  ".join([*map(str.ljust, line[:2], widths), *map(str.rjust, line[2:], widths[2:])]) for line in table]
    return "\n".join([rows[0].title, *map(str.rstrip, lines), *Verdict(rows).sentences()]) + "\n"


def as_csv(scenes):
    """report.csv of the rows of each scene, after RFC 4180 but with LF. Values that were not measured or do not exist
    are empty; the PSNR of equal pictures is inf. A cost is given only where it is interpolated; the page has bounds."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    lines.writerow(["scene", "renderer", "processor", "budget", "size", "views", "rays", "seconds",
                    *("seconds_" + stage for stage in STAGES), "runs", "peak_mb",
                    *(prefix + name for prefix in ["", *(region + "_" for region in REGIONS)] for name in FIGURES),
                    "psnr_sampling", "psnr_layers", "pull_flickering_pixels", "pull_sparkling_pixels", "pull_largest",
                    "equal_error_seconds", "equal_error_rays", "equal_time_db", "picture", "difference"])
    for rows in scenes:
        curves = ray_tracing_curves(rows)
        for row in rows:
            *reached, gained = compared(row, curves)
            numbers = [row.rays, row.total, *row.seconds, row.runs, row.peak_mb if row.runs > 0 else None,
                       *(errors[name] for errors in row.errors for name in FIGURES), *(row.causes or [None] * 2),
                       *(row.unsteady or [None] * 3), *(at[1] if at and not at[0] else None for at in reached), gained]
            lines.writerow([row.scene, row.renderer, row.processor, row.budget, row.size, row.views,
                            *map(shortest, numbers), row.shown, row.difference])
    return text.getvalue()
