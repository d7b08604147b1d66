#!/usr/bin/env python3
"""Measures what hidden surfaces are worth: the same scenes gathered from a renderer's own deep file, with guesses at
what it lacks, and from an LDI that ldi-warp makes of five views. Each is compared with a ray-traced reference. See
lab/results/hidden.md.

    hidden.py fence grass mist path/to/views -o FOLDER

A scene is the name of a dof-trace scene (dof-trace must be in PATH or in --bin), or a folder of ready-made views
(center.exr, four or eight view_K.exr, reference.exr, camera.json as dof-trace writes it). Files in FOLDER from an
earlier run are not traced again. Needs numpy, and oiiotool for the pictures.
"""
import argparse
import json
import math
import pathlib
import shutil
import subprocess

import numpy
import sparselens

BACKDROP = 1e9     # depth of the backdrop that replaces nothing, scene units
DETAIL = (96, 54)  # size of the enlarged detail, pixels
ENLARGED = 4
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"  # Debian's; OpenImageIO finds fonts by name up to 2.4 only


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", help="scenes of dof-trace, and folders of views")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="folder of the results")
    parser.add_argument("--bin", type=pathlib.Path, help="folder of dof-trace (default: that in PATH)")
    parser.add_argument("--size", default="640x360", help="size of the traced pictures")
    parser.add_argument("--spp", type=int, default=16, help="samples per pixel of the views and the deep files")
    parser.add_argument("--rays", type=int, default=4096, help="rays per pixel of the truth")
    parser.add_argument("--quality", default="final", choices=["draft", "normal", "final"])
    return parser.parse_args()


# --- The samples of an LDI, one row each ---

class Samples:
    """pixel: index of the pixel; z, z_back: depths; rgba: premultiplied, float32 (samples, 4). Sorted by pixel and
    depth."""

    def __init__(self, pixel, z, z_back, rgba):
        self.pixel, self.z, self.z_back, self.rgba = pixel, z, z_back, rgba

    @staticmethod
    def of(ldi):
        counts = numpy.diff(ldi.begin.astype(numpy.int64))
        pixel = numpy.repeat(numpy.arange(counts.size), counts)
        rgba = numpy.stack([ldi[name] for name in "RGBA"], axis=1)
        return Samples(pixel, ldi.z, ldi.z if ldi.z_back is None else ldi.z_back, rgba)

    def with_more(self, other):
        joined = [numpy.concatenate(pair) for pair in ((self.pixel, other.pixel), (self.z, other.z),
                                                       (self.z_back, other.z_back), (self.rgba, other.rgba))]
        order = numpy.lexsort((joined[1], joined[0]))
        return Samples(*(values[order] for values in joined))

    def ldi(self, like, more={}):
        """An Ldi with the windows and the camera of `like`, and further channels."""
        begin = numpy.searchsorted(self.pixel, numpy.arange(like.width * like.height + 1)).astype(numpy.uint64)
        channels = {name: numpy.ascontiguousarray(self.rgba[:, k]) for k, name in enumerate("RGBA")} | more
        volumes = {"z_back": self.z_back} if (self.z_back != self.z).any() else {}
        camera = like.camera
        return sparselens.Ldi(begin, self.z, channels, size=(like.width, like.height), data_window=like.data_window,
                              display_window=like.display_window, pixel_aspect=like.pixel_aspect, **volumes,
                              focal_length=camera.focal_length, sensor_width=camera.sensor_width,
                              lens_radius=camera.lens_radius, focus_distance=camera.focus_distance)


def before_nothing(samples, like):
    """Adds a black backdrop behind the samples. The gather takes it for the background everywhere, so it does not
    continue the true background, as it would otherwise. The channel "known.R" marks everything but the backdrop."""
    last = numpy.flatnonzero(numpy.diff(samples.pixel, append=-1))
    pixel = samples.pixel[last[numpy.isfinite(samples.z[last])]]  # the sky needs no backdrop
    z = numpy.full(pixel.size, BACKDROP, numpy.float32)
    black = numpy.tile(numpy.float32([0, 0, 0, 1]), (pixel.size, 1))
    both = samples.with_more(Samples(pixel, z, z, black))
    known = numpy.where(both.z == numpy.float32(BACKDROP), 0, both.rgba[:, 3])
    return both.ldi(like, {"known.R": known.astype(numpy.float32)})


# --- Guesses at the hidden background ---

def largest_circle(z, ldi):
    """The largest radius of a circle of confusion at these depths, in whole pixels: docs/design.md has the formula."""
    camera, width = ldi.camera, ldi.display_window[2] - ldi.display_window[0] + 1
    scale = camera.lens_radius * camera.focal_length / camera.sensor_width * width
    return math.ceil(numpy.abs(scale / camera.focus_distance * (1 - camera.focus_distance / z)).max())


def deepest(samples, shape):
    """The depth and colour of the last sample of each pixel; the depth is -inf if there is none."""
    last = numpy.flatnonzero(numpy.diff(samples.pixel, append=-1))
    z, rgba = numpy.full(shape, -numpy.inf), numpy.zeros(shape + (4,))
    z.flat[samples.pixel[last]] = samples.z_back[last]
    rgba.reshape(-1, 4)[samples.pixel[last]] = samples.rgba[last]
    return z, rgba


def depth_step(z):
    """The slope of a surface's own depth, per pixel: along each axis the smaller of the two steps, so that a silhouette
    does not count; then the larger of both axes."""
    steps = []
    for axis in (0, 1):
        step = numpy.abs(numpy.diff(numpy.where(numpy.isfinite(z), z, 1e10), axis=axis))
        pad = [(0, 0), (0, 0)]
        pad[axis] = (1, 1)
        padded = numpy.pad(step, pad, mode="edge")
        low, high = numpy.split(padded, [1], axis)[1], numpy.split(padded, [padded.shape[axis] - 1], axis)[0]
        steps.append(numpy.minimum(low, high))
    return numpy.maximum(*steps)


def shifted(values, dy, dx, empty):
    """values[y + dy, x + dx] at [y, x]."""
    out = numpy.full_like(values, empty)
    height, width = values.shape[:2]
    y0, y1, x0, x1 = max(0, -dy), min(height, height - dy), max(0, -dx), min(width, width - dx)
    if y0 < y1 and x0 < x1:
        out[y0:y1, x0:x1] = values[y0 + dy:y1 + dy, x0 + dx:x1 + dx]
    return out


def guessed(ldi, blurred):
    """Adds a sample behind each pixel that has something farther away beside it: the last sample of the nearest such
    pixel (as DeepC's DeepCDefocus fills), or the mean of all such pixels within reach, weighted by the inverse squared
    distance. The reach is the largest circle of confusion of the deepest samples. "Farther" means more than 2 % deeper,
    and deeper than four times the depth change of the pixel's own surface over that distance."""
    shape = (ldi.height, ldi.width)
    z, rgba = deepest(Samples.of(ldi), shape)
    reach = largest_circle(z[numpy.isfinite(z)], ldi)
    step = depth_step(z)
    found = numpy.zeros(shape)      # the sum of weights
    inverse = numpy.zeros(shape)    # weighted sum of 1 / z
    colour = numpy.zeros(shape + (4,))
    offsets = [(dy, dx) for dy in range(-reach, reach + 1) for dx in range(-reach, reach + 1)
               if 0 < dy * dy + dx * dx <= reach * reach]
    for dy, dx in sorted(offsets, key=lambda d: (d[0] ** 2 + d[1] ** 2, d)):
        distance = math.hypot(dy, dx)
        there = shifted(z, dy, dx, -numpy.inf)
        takes = there > z + numpy.maximum(0.02 * z, 4 * step * distance)
        takes &= numpy.isfinite(z)
        if not blurred:
            takes &= found == 0
        weight = takes / distance**2
        found += weight
        inverse += weight / numpy.where(takes, there, 1)
        colour += weight[..., None] * shifted(rgba, dy, dx, 0)
    pixel = numpy.flatnonzero(found)
    with numpy.errstate(divide="ignore"):
        z_new = (found.flat[pixel] / inverse.flat[pixel]).astype(numpy.float32)
    new = (colour.reshape(-1, 4)[pixel] / found.flat[pixel][:, None]).astype(numpy.float32)
    return Samples.of(ldi).with_more(Samples(pixel, z_new, z_new, new)).ldi(ldi)


# --- Pictures ---

def gathered(ldi, quality):
    return sparselens.gather(ldi, quality=quality, overscan="keep").pixels[..., :4]


def with_holes(ldi, quality):
    """Gathers without the gather's own fillers: unknown areas are black. Also returns the known share of each pixel."""
    picture = sparselens.gather(before_nothing(Samples.of(ldi), ldi), quality=quality, overscan="keep")
    return picture.pixels[..., :4], picture["known.R"][..., None]


def without_holes(ldi, quality):
    """The same, divided by the known share."""
    pixels, known = with_holes(ldi, quality)
    return pixels / numpy.maximum(known, 1e-6)


def pictures(views, visible, peeled, quality):
    """Yields (title, pixels) of all compared pictures."""
    yield "visible surfaces alone, holes left dark", with_holes(visible, quality)[0]
    yield "... divided by what is known", without_holes(visible, quality)
    yield "... the nearest background repeated behind", without_holes(guessed(visible, False), quality)
    yield "... the background blurred inwards", without_holes(guessed(visible, True), quality)
    yield "... dof-gather's own fillers", gathered(visible, quality)
    if peeled:
        yield "depth peeling, 4 layers", gathered(peeled, quality)
    yield "five views, ldi-warp", gathered(sparselens.warp(views), quality)


def framed(pixels, like, window):
    """Crops the pixels to the window of the reference."""
    left, top = like[0] - window[0], like[1] - window[1]
    return pixels[top:top + like[3] - like[1] + 1, left:left + like[2] - like[0] + 1]


def tone_mapped(pixels):
    return (numpy.maximum(pixels, 0) / (1 + numpy.maximum(pixels, 0))) ** (1 / 2.2)


def detail_of(error):
    """Left and top of the detail with the largest error."""
    width, height = DETAIL
    sums = numpy.pad(error.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    windows = sums[height:, width:] - sums[:-height, width:] - sums[height:, :-width] + sums[:-height, :-width]
    top, left = numpy.unravel_index(windows.argmax(), windows.shape)
    return left, top


def write_sheet(path, folder, panels):
    """Writes the titled panels in two columns."""
    words = []
    for k, (title, pixels) in enumerate(panels):
        name = folder / f"detail_{k}.exr"
        large = pixels[..., :3].repeat(ENLARGED, 0).repeat(ENLARGED, 1)
        sparselens.write(name, numpy.ascontiguousarray(large, dtype=numpy.float32), type="float")
        words += [name, "--colorconvert", "linear", "sRGB", "--clamp:min=0:max=1", "--fill:color=0.1,0.1,0.1",
                  f"{large.shape[1]}x18+0+0", f"--text:x=4:y=13:size=12:font={FONT}", title]
    run("oiiotool", *words, "--mosaic:pad=4", f"2x{(len(panels) + 1) // 2}", "-d", "uint8", "-o", path)


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def traced(scene, asked):
    """The folder with a scene's views, deep files and reference; traces missing ones."""
    folder = asked.output / scene
    if not (folder / "reference.exr").exists():
        trace = asked.bin / "dof-trace" if asked.bin else "dof-trace"
        run(trace, scene, "-o", folder, "--size", asked.size, "--spp", asked.spp, "--reference", asked.rays,
            "--deep", "visible", "--deep", "peel:4")
    return folder


def views_in(folder):
    """The centre view and four rim views, with the lens of camera.json, which files of other renderers do not state."""
    said = json.loads((folder / "camera.json").read_text())
    lens = {"focal_length": said["focal_mm"], "sensor_width": said["sensor_width_mm"],
            "lens_radius": said["lens_radius"], "focus_distance": said["focus_distance"]}
    views = [sparselens.open_view(folder / "center.exr", position=(0, 0), **lens)]
    points = list(enumerate(said["views"]))
    for k, point in points[::len(points) // 4]:  # four, evenly around the rim
        position = tuple(said["lens_radius"] * coordinate for coordinate in point)
        views.append(sparselens.open_view(folder / f"view_{k}.exr", position=position, **lens))
    return views


def compared(scene, asked):
    """The figures of a scene: {title: (dB, SSIM)}. Writes its pictures."""
    folder = pathlib.Path(scene) if pathlib.Path(scene).is_dir() else traced(scene, asked)
    views = views_in(folder)
    truth = sparselens.open_picture(folder / "reference.exr")
    deep = (folder / "deep_visible.exr").exists()
    visible = sparselens.open_ldi(folder / "deep_visible.exr") if deep else sparselens.warp(views[:1])
    peeled = sparselens.open_ldi(folder / "deep_peel.exr") if deep else None
    border = largest_circle(visible.z, visible)
    inside = (slice(border, -border), slice(border, -border))
    expected = numpy.ascontiguousarray(truth.pixels[..., :4], dtype=numpy.float32)
    out = asked.output / folder.name
    out.mkdir(parents=True, exist_ok=True)
    figures, panels, corner = {}, [], None
    for title, pixels in pictures(views, visible, peeled, asked.quality):
        pixels = framed(pixels, truth.data_window, visible.data_window) if pixels.shape[:2] == (
            visible.height, visible.width) else pixels
        sparselens.write(out / f"{len(figures)}.exr", numpy.ascontiguousarray(pixels, dtype=numpy.float32))
        found = sparselens.compare(numpy.ascontiguousarray(pixels[inside]), numpy.ascontiguousarray(expected[inside]))
        figures[title] = found["psnr_tonemapped"], found["ssim"]
        if title.startswith("... divided"):
            error = ((tone_mapped(pixels) - tone_mapped(expected)) ** 2)[..., :3].sum(-1)
            left, top = detail_of(error[inside])
            corner = (slice(top + border, top + border + DETAIL[1]), slice(left + border, left + border + DETAIL[0]))
        panels.append((title, pixels, found["psnr_tonemapped"]))
    shown = [(f"{title}: {db:.1f} dB", pixels[corner]) for title, pixels, db in panels]
    write_sheet(asked.output / f"{folder.name}.png", out, shown + [("the truth", expected[corner])])
    return folder.name, figures


def print_table(results):
    titles = list(dict.fromkeys(title for _, figures in results for title in figures))
    print(f"{'dB (SSIM), borders left out':44}" + "".join(f"{name:>16}" for name, _ in results))
    for title in titles:
        cells = ("{:.2f} ({:.4f})".format(*figures[title]) if title in figures else "-" for _, figures in results)
        print(f"{title:44}" + "".join(f"{cell:>16}" for cell in cells))


def main():
    asked = arguments()
    if not shutil.which("oiiotool"):
        raise SystemExit("hidden.py: needs oiiotool (Debian: openimageio-tools)")
    print_table([compared(scene, asked) for scene in asked.scenes])


if __name__ == "__main__":
    try:
        main()
    except (sparselens.Error, sparselens.UsageError) as error:
        raise SystemExit(f"hidden.py: {error}")
