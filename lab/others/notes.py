"""Measures the cost of a note, in seconds and rays per pixel for each way to answer it, with the command. In the folder
that lab/denoise and more.sh filled:

    python notes.py SCENE WIDTHxHEIGHT LIGHT      prints Markdown

All ways begin with the same 80 rays per pixel, which the shot already has. Ray tracing traces them again, and a
denoiser runs on them; averages are computed again from the existing views; five views are only gathered. A matte shows
the object in the plane of focus. Seconds are wall time of the fastest of three runs, including start, reading and
writing.
"""
import glob
import json
import pathlib
import subprocess
import sys
import time

import numpy
import OpenEXR
import pyoidn

scene, size, light = sys.argv[1:]
camera = json.loads(pathlib.Path("camera.json").read_text())
focus, radius = camera["focus_distance"], camera["lens_radius"]
views = ["center.exr"] + [f"view_{k}.exr" for k in range(4)]


def seconds_of(words):
    times = []
    for _ in range(3):
        start = time.perf_counter()
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        times.append(time.perf_counter() - start)
    return min(times)


def rgb(path):
    with OpenEXR.File(path, separate_channels=True) as file:
        return numpy.stack([file.channels()[c].pixels for c in "RGB"], axis=2).astype(numpy.float32)


def denoiser_seconds():
    colour, albedo, normal = rgb("note/reference.exr"), rgb("traced-80-albedo/reference.exr"), rgb("traced-80-normal/reference.exr")
    times = []
    for _ in range(3):
        start = time.perf_counter()
        pyoidn.denoise(colour.clip(0, None), albedo=albedo.clip(0, 1), normal=normal.clip(-1, 1), hdr=True)
        times.append(time.perf_counter() - start)
    return min(times)


def with_matte(name):
    """A view with a channel for the object in focus, as a renderer's id would give."""
    with OpenEXR.File(name, separate_channels=True) as file:
        channels = dict(file.channels())
        z = channels["Z"].pixels
        channels["matte.A"] = OpenEXR.Channel("matte.A", (abs(z / focus - 1) < 0.15).astype(numpy.float32))
        OpenEXR.File(file.header(), channels).write(f"note/{name}")


pathlib.Path("note").mkdir(exist_ok=True)
for name in views:
    with_matte(name)
subprocess.run(["ldi-warp", *(f"note/{name}" for name in views), "-o", "note/shot.ldi.exr"], check=True)
lens_views = sorted(glob.glob("accumulated-80/lens_*.exr"))
notes = [("focus 10 % nearer", ["--focus-distance", f"{0.9 * focus:g}"]), ("two stops down", ["--lens-radius", f"{radius / 2:g}"]),
         ("six blades", ["--blades", "6"]), ("matte of one object", None)]
print("| note | ray tracing, denoised or not | denoiser | averages of views | five views |")
print("|---|---|---|---|---|")
commands = []
for note, look in notes:
    # The matte of the same picture: ids through the same lens, which need no lighting.
    trace = ["dof-trace", scene, "--size", size, "--light", light if look else "albedo", "--views", "0", "--spp", "1", "--reference", "80",
             "-o", "note", *(look or [])]
    average = ["dof-accumulate", *lens_views, *(look or []), "-o", "note/average.exr"]
    gather = ["dof-gather", "note/shot.ldi.exr", *(look or ["--channels", "matte.A"]), "-o", "note/picture.exr"]
    cells = [f"{seconds_of(trace):.2f} s, 80 rays", f"{denoiser_seconds():.2f} s more"]
    cells.append("again: no shape of the aperture" if note == "six blades" else "again" if not look else f"{seconds_of(average):.2f} s, 0 rays")
    cells.append(f"{seconds_of(gather):.2f} s, 0 rays")
    print(f"| {note} | " + " | ".join(cells) + " |", flush=True)
    commands.append(f"{note}: `{' '.join(trace)}`; `{' '.join(gather)}`")
print()
for command in commands:
    print("- " + command)
