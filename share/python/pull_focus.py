#!/usr/bin/env python3
"""Pulls the focus over one set of views: warps them once, and writes a picture for each focus distance.

    pull_focus.py center.exr view_0.exr view_1.exr ... -o FOLDER --focus 2.2 3.4 5

Each picture is written as EXR, and as PNG for the screen. Options describe the lens if the views do not.
"""
import argparse
import pathlib
import sys

import sparselens


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("views", nargs="+", help="the centre view, then the views from the rim of the lens")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("."), help="folder of the pictures")
    parser.add_argument("--focus", type=float, nargs="+", required=True, help="focus distances, scene units")
    parser.add_argument("--fstop", type=float, help="f-number (default: that of the views)")
    parser.add_argument("--lens-radius", type=float, help="radius of the aperture, scene units, instead of --fstop")
    parser.add_argument("--quality", choices=["draft", "normal", "final"], default="normal")
    return parser.parse_args()


def say(stage, percent):
    print(f"\r{stage} {percent} %  ", end="" if percent < 100 else "\n", file=sys.stderr)


def main():
    asked = arguments()
    views = [sparselens.open_view(name) for name in asked.views]
    ldi = sparselens.cluster(sparselens.warp(views, progress=say), progress=say)
    print(f"{len(views)} views, {ldi.samples} samples in {ldi.width} x {ldi.height} pixels")
    for distance in asked.focus:
        picture = sparselens.gather(ldi, focus_distance=distance, fstop=asked.fstop, lens_radius=asked.lens_radius,
                                    quality=asked.quality, progress=say)
        name = asked.output / f"focus_{distance:g}"
        sparselens.write(name.with_name(name.name + ".exr"), picture)
        sparselens.write(name.with_name(name.name + ".png"), picture)
        print(f"{name}.exr, {name}.png: mean {picture.pixels[..., :3].mean():.4f}")


if __name__ == "__main__":
    try:
        main()
    except (sparselens.Error, sparselens.UsageError) as error:
        sys.exit(f"pull_focus.py: {error}")
