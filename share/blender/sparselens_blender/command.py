"""The command line of the script."""

import argparse
import json
import re
import sys
import traceback

import bpy

from .renders import AUTO, render_frames
from .shots import eyes_of, shot_of
from .views import check_plan, numbered, views_of_lens, views_of_plan


def frame_numbers(text):
    """The frames of "1-24", "1-100x2" or "3,5-7", in that order."""
    numbers = []
    for part in text.split(","):
        match = re.fullmatch(r"(-?\d+)(?:-(-?\d+)(?:x([1-9]\d*))?)?", part)
        if not match:
            raise argparse.ArgumentTypeError(
                "invalid frame range '%s' (expected e.g. 1-100x2)" % text)
        first = int(match[1])
        last = first if match[2] is None else int(match[2])
        step = int(match[3] or 1)
        numbers += (range(first, last + 1, step) if first <= last
                    else range(first, last - 1, -step))
    return numbers


def natural_number(text):
    if not re.fullmatch(r"\d{1,6}", text):
        raise argparse.ArgumentTypeError("'%s' is not a number from 0" % text)
    return int(text)


def overscan_option(text):
    return AUTO if text == AUTO else natural_number(text)


def read_options(arguments):
    parser = argparse.ArgumentParser(
        prog="sparselens_views.py",
        usage="blender -b SCENE.blend -P sparselens_views.py -- -o DIR "
              "[options]",
        description="Renders the centre view and the views from the rim of "
                    "the lens, from the scene's camera.")
    add = parser.add_argument
    add("-o", "--output", required=True, metavar="DIR",
        help="folder of the views: center.exr, view_0.exr, ...")
    add("--views", type=natural_number, default=4, metavar="N",
        help="views from the rim of the lens (default: 4)")
    frames = parser.add_mutually_exclusive_group()
    frames.add_argument(
        "--frame", type=int, metavar="N",
        help="frame to render (default: the scene's current one)")
    frames.add_argument(
        "--frames", type=frame_numbers, metavar="RANGE",
        help="frames to render, e.g. 1-24; the files are center.####.exr, "
             "view_0.####.exr, ...")
    add("--samples", type=natural_number, metavar="N",
        help="samples a pixel of the picture (default: the scene's)")
    add("--supersample", type=natural_number, default=1, metavar="N",
        help="render N times the width and height with 1/N^2 of the samples "
             "a pixel; dof-gather makes the picture of the scene's size of "
             "it (default: 1)")
    add("--overscan", type=overscan_option, default=0, metavar="PX",
        help="pixels of the picture to render beyond each side (default: 0); "
             "auto: as many as the blur at the border of each frame needs")
    add("--multilayer", action="store_true",
        help="multilayer EXR with all passes of the view layers, AOVs and "
             "Cryptomatte too (default: colour and depth)")
    add("--layer", metavar="NAME",
        help="the only view layer to render (default: all that are switched "
             "on; without --multilayer there may be only one)")
    add("--eye", metavar="NAME",
        help="view of a stereo scene, e.g. left (default: all of them, the "
             "eye's suffix in the names of the files)")
    add("--plan", metavar="PLAN.json",
        help="render only what this file of ldi-plan asks for, a file a "
             "rectangle: view_0_0.exr, ...; plan.####.json for --frames")
    add("--lens-views", type=natural_number, default=0, metavar="N",
        help="also render N views spread over the lens, lens_0000.exr, ..., "
             "whose average (dof-accumulate) is the true picture")
    options = parser.parse_args(arguments)
    if options.samples == 0:
        parser.error("argument --samples: 0 samples make no picture")
    if not 1 <= options.supersample <= 16:
        parser.error("argument --supersample: must be from 1 to 16")
    if options.supersample > 1 and options.lens_views:
        parser.error("argument --lens-views: their average is the picture: "
                     "render them without --supersample")
    return options


def chosen_eyes(scene, name):
    eyes = eyes_of(scene)
    if name is None:
        return eyes
    chosen = [eye for eye in eyes if eye.name == name]
    if not chosen:
        raise ValueError("--eye: the scene has no eye '%s'; it has: %s" % (
            name, ", ".join(eye.name or "one without a name" for eye in eyes)))
    return chosen


def main(arguments):
    options = read_options(arguments)
    scene = bpy.context.scene
    eyes = chosen_eyes(scene, options.eye)
    if options.plan and len(eyes) > 1:
        raise ValueError("--plan: a plan is made for one eye: name it (--eye)")
    if options.samples:
        scene.cycles.samples = options.samples
        scene.eevee.taa_render_samples = options.samples

    def views_at(frame):
        if not options.plan:
            return views_of_lens(options.views, options.lens_views)
        with open(numbered(options.plan, frame)) as file:
            plan = json.load(file)
        check_plan(plan, shot_of(scene, eyes[0], options.supersample).size,
                   options.supersample)
        return views_of_plan(plan)

    frames = options.frames
    if frames is None:
        frames = [scene.frame_current if options.frame is None
                  else options.frame]
    render_frames(scene, frames, options.output, views_at, eyes,
                  several=options.frames is not None,
                  overscan=options.overscan, multilayer=options.multilayer,
                  layer=options.layer, supersample=options.supersample)


def run_as_script():
    """Blender goes on after an exception, and ends with 0: end it here."""
    after = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    try:
        main(sys.argv[after:])
    except (ValueError, OSError, RuntimeError) as error:
        print("sparselens_views.py: error:", error, file=sys.stderr)
        sys.exit(1)
    except Exception:
        traceback.print_exc()
        sys.exit(1)
