#!/usr/bin/env python3
"""Submits views to pictures to OpenCue: a layer of LDIs, and a layer of pictures that depends on it frame by frame.

    submit.py --frames 1-24 --views /shots/010/views --output /shots/010/out -- --focus-distance 3
    submit.py --frames 1-24 --scene /shots/010/shot.blend --output /shots/010/out -- --samples 64 --finish 80

The views are center.####.exr, view_0.####.exr, ...; the words after -- are options of dof-gather. With --scene, one layer
renders the views in Blender and makes the pictures, and the words are options of that command
(share/blender/README.md). Needs OpenCue's Python packages (pyoutline). A frame that runs again keeps complete files.
docs/farm.md says more.
"""
import argparse
import pathlib
import re
import shlex
import sys

import outline
import outline.cuerun
from outline.modules.shell import Shell

# Cuebot replaces these with the first and last frame of the chunk that it starts.
FRAMES = "--frames=#FRAME_START#-#FRAME_END#"


def chunk(text):
    if not re.fullmatch(r"[1-9]\d{0,5}", text):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number from 1")
    return int(text)


def arguments(words):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", required=True, metavar="RANGE", help="frames, e.g. 1-24 or 1-24x2")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--views", type=pathlib.Path, metavar="DIR", help="folder of the views")
    source.add_argument("--scene", metavar="FILE.blend", help="scene whose views Blender renders; its pictures are named 0001 and so on")
    parser.add_argument("--script", metavar="FILE.py",
                        help="with --scene, path of sparselens_views.py (default: Blender 4.2 or later has the add-on)")
    parser.add_argument("--output", required=True, type=pathlib.Path, metavar="DIR", help="folder of LDIs and pictures")
    parser.add_argument("--chunk", type=chunk, default=1, metavar="N",
                        help="frames that one process works on; more than 1 only for frames in a row (default: 1)")
    parser.add_argument("options", nargs="*", metavar="-- OPTIONS", help="options of dof-gather, or of the command in Blender")
    options = parser.parse_args(words)
    if options.script and not options.scene:
        parser.error("--script needs --scene")
    if options.chunk > 1 and not re.fullmatch(r"-?\d+(--?\d+)?", options.frames):
        parser.error(f"--chunk {options.chunk} needs frames in a row, e.g. 1-24, not {options.frames}: "
                     "a process makes all frames from its first to its last")
    return options


def rim_views(folder):
    """The sequences of the views from the rim of the lens, e.g. view_0.####.exr."""
    names = {re.sub(r"\.-?\d+\.exr$", ".####.exr", path.name) for path in folder.glob("view_*.*.exr")}
    if not names:
        sys.exit(f"submit.py: {folder} holds no view_*.####.exr: render the views first")
    return [str(folder / name) for name in sorted(names)]


def layers(options):
    """The names and the words of the layers, each of which depends on the one before. Cuebot joins words by blanks for a
    shell."""
    if options.scene:
        command = ["-P", options.script, "--", "--picture"] if options.script else ["--command", "sparselens"]
        picture = ["blender", "-b", options.scene, *command, "-o", str(options.output / "####"), FRAMES, *options.options]
        found = [("picture", picture)]
    else:
        ldi, picture = str(options.output / "ldi.####.exr"), str(options.output / "picture.####.exr")
        warp = ["ldi-warp", str(options.views / "center.####.exr"), *rim_views(options.views), "-o", ldi, FRAMES]
        found = [("warp", warp), ("gather", ["dof-gather", ldi, "-o", picture, FRAMES, *options.options])]
    return [(name, [shlex.quote(word) for word in words]) for name, words in found]


def main(words):
    options = arguments(words)
    job, before = outline.Outline("sparselens", frame_range=options.frames), None
    for name, command in layers(options):
        layer = Shell(name, command=command, range=options.frames, chunk=options.chunk, threadable=True)
        job.add_layer(layer)
        if before:
            layer.depend_on(before)  # frame by frame
        before = layer
    outline.cuerun.launch(job, use_pycuerun=False)


if __name__ == "__main__":
    main(sys.argv[1:])
