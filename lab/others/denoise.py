"""Runs Open Image Denoise on the pictures of a folder: reads `jobs`, one line for each picture: PICTURE ALBEDO NORMAL
KIND.

KIND says what albedo and normals are: clean (without noise), noisy (from the same rays), pinhole (from other rays: the
result is named PICTURE.pinhole.exr and is not a row), frame (from the same rays: NAME.pull.0001.exr becomes
NAME.denoised.pull.0001.exr). Without them, both are -. The seconds of the second of two runs are added to those of the
picture in the cost.json or camera.json beside it.
"""
import json
import pathlib
import time

import numpy
import OpenEXR
import pyoidn


def rgb(path):
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return numpy.stack([channels[c].pixels for c in "RGB"], axis=2).astype(numpy.float32)


def note(folder, name, of, seconds):
    path = folder / "cost.json"  # of renders alone, which are no budget of their own
    path = path if path.exists() else folder / "camera.json"
    camera = json.loads(path.read_text())
    camera["seconds"][name] = round(camera["seconds"][of] + seconds, 3)
    path.write_text(json.dumps(camera, indent=1) + "\n")


for line in open("jobs"):
    path, albedo, normal, kind = line.split()
    path = pathlib.Path(path)
    guides = {} if albedo == "-" else {"albedo": rgb(albedo).clip(0, 1), "normal": rgb(normal).clip(-1, 1)}
    for _ in range(2):
        start = time.perf_counter()
        result = pyoidn.denoise(rgb(path).clip(0, None), **guides, hdr=True, clean_aux=kind == "clean")
        seconds = time.perf_counter() - start
    output = path.with_suffix(".pinhole.exr" if kind == "pinhole" else ".denoised.exr")
    if kind == "frame":
        output = path.with_name(path.name.replace(".pull.", ".denoised.pull."))
    with OpenEXR.File(str(path), separate_channels=True) as file:  # all else stays: depth, the camera
        for c, name in enumerate("RGB"):
            channel = file.channels()[name]
            channel.pixels = result[..., c].astype(channel.pixels.dtype)
        file.write(str(output))
    if kind in ("clean", "noisy"):
        note(path.parent, output.name, path.name, seconds)
