"""Measures the rows of a scene against its reference, from the files that the steps wrote; dof-compare has the figures.
Writes PNG files of each row's picture, of its difference times 8 and of its worst place, tone-mapped as there."""
import concurrent.futures
import json
import math
import os
import subprocess
import sys

import numpy
import OpenImageIO

from rows import FIGURES, REGIONS
from steps import Failure, TimeLeft, matching

FLIP = "import flip_evaluator, sys; print(flip_evaluator.evaluate(*sys.argv[1:], 'HDR', applyMagma=False)[1])"
BLOCK, AROUND, GAP = 8, 32, 2  # pixels: a block, what is shown around the worst, the gap beside it


def tone_mapped(values):
    with numpy.errstate(invalid="ignore"):  # inf / inf
        values = numpy.maximum(values, 0)
        return (values / (1 + values)) ** (1 / 2.2)


def read(path):
    """The picture, and the numbers of its channels by their names."""
    buffer = OpenImageIO.ImageBuf(path)
    if not buffer.read(0, 0, True, "float"):
        raise Failure(f"{path}: {buffer.geterror()}")
    return buffer, {name: number for number, name in enumerate(buffer.spec().channelnames)}


def write_png(path, pixels):
    """0 becomes 0, 1 becomes 255, NaN becomes 0."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    pixels = numpy.rint(255 * numpy.clip(numpy.nan_to_num(pixels, nan=0), 0, 1)).astype(numpy.uint8, order="C")
    buffer = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(pixels.shape[1], pixels.shape[0], 3, "uint8"))
    buffer.set_pixels(OpenImageIO.ROI(), pixels)
    if not buffer.write(path):
        raise Failure(f"{path}: {buffer.geterror()}")


def worst_block(a, b):
    """(left, top) of the 8 x 8 pixels with the largest mean square difference, of those that are finite in both."""
    squares = ((a.astype(numpy.float64) - b) ** 2).mean(axis=2)
    squares = numpy.pad(squares, [(0, -length % BLOCK) for length in squares.shape], constant_values=math.nan)
    blocks = squares.reshape(-1, BLOCK, squares.shape[1] // BLOCK, BLOCK)
    finite = numpy.isfinite(blocks)
    means = numpy.where(finite, blocks, 0).sum(axis=(1, 3)) / numpy.maximum(finite.sum(axis=(1, 3)), 1)
    row, column = numpy.unravel_index(means.argmax(), means.shape)
    return BLOCK * column, BLOCK * row


def around(block, picture, reference):
    """The surroundings of a block, by its left and upper pixel, in each picture, side by side with a white gap."""
    left, top = (min(max(at + (BLOCK - AROUND) // 2, 0), max(0, length - AROUND))
                 for at, length in zip(block, picture.shape[1::-1]))
    pair = numpy.ones((AROUND, 2 * AROUND + GAP, 3))
    for start, pixels in (0, picture), (AROUND + GAP, reference):
        part = pixels[top:top + AROUND, left:left + AROUND]
        pair[:part.shape[0], start:start + part.shape[1]] = part
    return pair


def flip(*files):
    """The mean of FLIP; NaN if the Python that SPARSELENS_FLIP_PYTHON names, or else this one, lacks its module."""
    words = [os.environ.get("SPARSELENS_FLIP_PYTHON", sys.executable), "-c", FLIP, *files]
    done = subprocess.run(words, capture_output=True, text=True)
    return math.nan if done.returncode else float(done.stdout)


class Measured:
    """A scene and its reference; `picture` is the file in which the page shows that."""

    def __init__(self, scene, runner, rows):
        self.runner, self.left = runner, TimeLeft([1] * rows)
        reference, centre = scene.reference(), scene.views(0, scene.samples[-1])
        if centre is None:
            raise Failure(f"{scene.name}: camera.json has no seconds of center.exr")
        self.reference, self.picture = reference.picture, f"pictures/{reference.folder}/picture.png"
        self.regions = ["--regions", centre.picture, *scene.lens]
        self.roi = read(runner.path(self.reference))[0].roi
        self.size = f"{self.roi.width}x{self.roi.height}"
        self.mapped = self.tone_mapped(self.reference)
        write_png(runner.path(self.picture), self.mapped)

    def tone_mapped(self, file):
        """R, G and B over the data window of the reference."""
        buffer, numbers = read(self.runner.path(file))
        roi = self.roi.copy()
        roi.chbegin, roi.chend = 0, buffer.nchannels
        return tone_mapped(buffer.get_pixels("float", roi)[..., [numbers[name] for name in "RGB"]])

    def compare(self, *words):
        return json.loads(self.runner.run_tool(["dof-compare", *words, "--json"], 1, stdout=subprocess.PIPE)[2])

    def figures(self, picture):
        """Figures of the whole picture, then of each region. In JSON infinity, of equal pictures, is null as NaN is."""
        said = self.compare(picture, self.reference, *self.regions)
        said["flip"] = flip(*map(self.runner.path, (self.reference, picture)))
        for part in (parts := [said, *(said["regions"][region] for region in REGIONS)]):
            part |= {f"nonfinite_{name}": count for name, count in part["nonfinite"].items()}
            for name in FIGURES:
                if part.setdefault(name, math.nan) is None:
                    part[name] = math.inf if part["pixels"] and name.startswith("psnr") else math.nan
        return parts

    def steadiness(self, frames):
        """Frames are NAME.NUMBER.exr. A sequence of fewer than three has no second difference."""
        if len(frames) < 3:
            return ()
        names = [frame.rsplit(".", 2) for frame in frames]
        said = self.compare(f"{names[0][0]}.####.exr", "--frames", ",".join(str(int(number)) for _, number, _ in names))
        return said["above_0.02"], said["above_0.05"], said["largest"]

    def measure(self, row):
        self.left.begin(f"{row.scene}: measuring")
        row.size = self.size
        for step in row.steps:
            row.seconds = [a + b for a, b in zip(row.seconds, step.seconds)]
            row.peak_mb = max(row.peak_mb, step.peak_mb)
            row.runs = min(row.runs or step.runs, step.runs)
        for file in matching(row.rim[0][0], self.runner.folder) if row.partial_samples else []:
            view, numbers = read(self.runner.path(file))
            rendered = numpy.count_nonzero(view.get_pixels("float")[..., numbers["A"]])  # others have alpha 0
            row.rays += row.partial_samples * rendered / self.roi.npixels
            row.views += 1
        row.errors = self.figures(row.picture)
        if row.many_points:
            pairs = (row.picture, row.many_points), (row.many_points, self.reference)
            found = [self.compare(*pair)["psnr_tonemapped"] for pair in pairs]
            row.causes = [math.inf if db is None else db for db in found]
        row.unsteady = self.steadiness(row.pull)
        # A folder of its own, because the EXR files may be ready-made and elsewhere.
        name = f"pictures/{row.scene}/{row.method} {row.budget}".replace(" ", "-").replace("+", "p").replace(",", "")
        row.shown, row.difference, row.worst = name + ".png", name + "-difference.png", name + "-worst.png"
        mapped = self.tone_mapped(row.picture)
        for file, pixels in [(row.shown, mapped), (row.difference, 8 * abs(mapped - self.mapped)),
                             (row.worst, around(worst_block(mapped, self.mapped), mapped, self.mapped))]:
            write_png(self.runner.path(file), pixels)


def measure_rows(scene, rows, runner):
    """Measures each row; returns the file of the reference's picture."""
    measured = Measured(scene, runner, len(rows))
    with concurrent.futures.ThreadPoolExecutor(runner.threads or len(os.sched_getaffinity(0))) as pool:
        list(pool.map(measured.measure, rows))
    measured.left.show()
    return measured.picture
