"""The options of the script, and of Blender's --command sparselens."""

import argparse
import re
import shlex

from .layers import names_of
from .shutter import MOST
from .sub_pixels import AUTO


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


def number_or_auto(text):
    return AUTO if text == AUTO else natural_number(text)


def add_options(add, exclusive):
    add("-o", "--output", required=True, metavar="DIR",
        help="folder of the views: center.exr, view_0.exr, ...; for pictures, "
             "their name, such as //out/####.exr. Without an ending, they "
             "have the format of the scene's output settings")
    add("--views", type=natural_number, default=4, metavar="N",
        help="views from the rim of the lens (default: 4)")
    frames = exclusive()
    frames.add_argument(
        "--frame", type=int, metavar="N",
        help="frame to render (default: the scene's current one)")
    frames.add_argument(
        "--frames", type=frame_numbers, metavar="RANGE",
        help="frames to render, e.g. 1-24; the files are center.####.exr, "
             "view_0.####.exr, ... (default of pictures whose name has #: "
             "those of the scene)")
    add("--samples", type=natural_number, metavar="N",
        help="samples per pixel of the picture (default: the scene's)")
    add("--supersample", type=number_or_auto, default=AUTO, metavar="N",
        help="render N times the width and height with 1/N^2 of the samples "
             "per pixel; dof-gather makes a picture of the scene's size; "
             "auto: 2 if ldi-plan advises it for the first, the middle or the "
             "last frame, else 1 (default: auto)")
    add("--overscan", type=number_or_auto, default=AUTO, metavar="PX",
        help="pixels of the picture to render beyond each side; auto: as "
             "many as the blur at the border of each frame needs (default: "
             "auto)")
    add("--multilayer", action="store_true",
        help="write multilayer EXR with all passes of the view layers, also "
             "AOVs and Cryptomatte (default: colour and depth)")
    add("--layer", metavar="NAME",
        help="the only view layer to render (default: all that are switched "
             "on; without --multilayer there may be only one)")
    add("--eye", metavar="NAME",
        help="view of a stereo scene, e.g. left (default: all of them, the "
             "eye's suffix in the names of the files)")
    add("--slices", type=natural_number, default=0, metavar="N",
        help="render the volumes by themselves, in N slices of depth: "
             "volume.exr, a deep EXR, for ldi-cluster. The views are then "
             "without volumes (Cycles)")
    add("--layers", type=names_of, default=(), metavar="NAME,...",
        help="render these see-through objects or collections each as a "
             "layer of its own: NAME/center.exr, NAME/view_0.exr, ... The "
             "other views are then without them")
    add("--shutter", type=natural_number, default=1, metavar="N",
        help="render N moments while the shutter of the scene's motion blur "
             "is open, each with 1/N of the samples, for a picture with "
             "motion blur: center_0.exr, view_0_0.exr, ..., center_1.exr, "
             "... (default: 1, a still)")
    add("--finish", type=natural_number, default=0, metavar="N",
        help="also render two pictures through the camera's lens that share "
             "no noise, with N samples per pixel together: rays_1.exr and "
             "rays_2.exr (Cycles). With pictures, finish these by them")


def add_views_options(add):
    add("--plan", metavar="PLAN.json",
        help="render only the rectangles of this plan of ldi-plan, one file "
             "each: view_0_0.exr, ...; plan.####.json for --frames")
    add("--lens-views", type=natural_number, default=0, metavar="N",
        help="also render N views spread over the lens, lens_0000.exr, ..., "
             "whose average (dof-accumulate) is the true picture")


def add_picture_options(add):
    add("--views-folder", metavar="DIR",
        help="with pictures, folder of the views and LDIs, which stay there "
             "(default: views, in the folder of the pictures)")
    add("--again", action="store_true",
        help="with pictures, render all views, also those of an earlier run "
             "with the same camera, size and samples")
    add("--looks", type=shlex.split, metavar="OPTIONS",
        help="with pictures, options of dof-gather, e.g. '--cat-eye 0.5' "
             "(default: the looks of the panel)")
    add("--tools", default="", metavar="DIR",
        help="with pictures, folder of ldi-warp and dof-gather (default: "
             "beside the add-on, in pip's package, or on the PATH)")


def check_options(parser, options):
    if options.samples == 0:
        parser.error("argument --samples: 0 samples make no picture")
    if options.lens_views and options.supersample == AUTO:
        options.supersample = 1
    if options.supersample != AUTO and not 1 <= options.supersample <= 16:
        parser.error("argument --supersample: must be from 1 to 16, or auto")
    if options.lens_views and options.supersample > 1:
        parser.error("argument --lens-views: their average is the picture: "
                     "render them without --supersample")
    if options.lens_views and (options.slices or options.layers):
        parser.error("argument --lens-views: their average is the picture: "
                     "render them without --slices and --layers")
    if not 1 <= options.shutter <= MOST:
        parser.error("argument --shutter: must be from 1 to %d" % MOST)
    for name in "plan", "lens_views", "finish":
        if options.shutter > 1 and getattr(options, name):
            parser.error("argument --%s: shows one moment: not allowed with "
                         "argument --shutter" % name.replace("_", "-"))
    if options.finish == 1:
        parser.error("argument --finish: two renders take two samples")
    if options.picture:
        for name in "plan", "lens_views":
            if getattr(options, name):
                parser.error("argument --%s: not allowed with argument "
                             "--picture" % name.replace("_", "-"))
        return
    for name in "views_folder", "again", "looks", "tools":
        if getattr(options, name):
            parser.error("argument --%s: needs --picture"
                         % name.replace("_", "-"))


def read_options(arguments, command=False):
    """The parser for the script, or for Blender's --command sparselens."""
    if command:
        parser = argparse.ArgumentParser(
            prog="sparselens", usage="blender -b SCENE.blend --command "
            "sparselens -o //out/#### [options]", description="Renders views "
            "from the lens of the scene's camera, and makes pictures of "
            "them.")
        parser.set_defaults(picture=True, plan=None, lens_views=0)
    else:
        parser = argparse.ArgumentParser(
            prog="sparselens_views.py",
            usage="blender -b SCENE.blend -P sparselens_views.py -- -o DIR "
                  "[options]",
            description="Renders the centre view and the views from the rim "
                        "of the lens, from the scene's camera.")
        parser.add_argument(
            "--picture", action="store_true", help="also make pictures of "
            "the views, named by -o")
    add_options(parser.add_argument, parser.add_mutually_exclusive_group)
    if not command:
        add_views_options(parser.add_argument)
    add_picture_options(parser.add_argument)
    options = parser.parse_args(arguments)
    check_options(parser, options)
    return options
