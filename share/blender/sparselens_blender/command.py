"""The command line of the script, which renders views and with --picture makes
pictures of them, and of Blender's --command sparselens, which makes pictures.
"""

import json
import os
import sys
import traceback

import bpy

from . import costs, panel
from .manner import Count, Manner
from .options import read_options
from .renders import folder_of, render_now, views_steps
from .sequence import Pictures
from .shots import eyes_of, shot_of
from .shutter import shutter_options
from .sub_pixels import AUTO
from .views import (
    check_plan, counted, numbered, views_of_lens, views_of_plan)


def chosen_eyes(scene, name):
    eyes = eyes_of(scene)
    if name is None:
        return eyes
    chosen = [eye for eye in eyes if eye.name == name]
    if not chosen:
        raise ValueError("--eye: the scene has no eye '%s'; it has: %s" % (
            name, ", ".join(eye.name or "one without a name" for eye in eyes)))
    return chosen


def frames_of(options, scene):
    if options.frames is not None:
        return options.frames
    if options.frame is not None:
        return [options.frame]
    if options.picture and "#" in os.path.basename(options.output):
        return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
    return [scene.frame_current]


def tell(words):
    if words:
        print("sparselens:", words)


def render_views(options, scene, eyes, manner, say):
    if options.plan and len(eyes) > 1:
        raise ValueError("--plan: a plan is made for one eye: name it (--eye)")

    def views_at(frame):
        if not options.plan:
            return views_of_lens(options.views, options.lens_views)
        with open(numbered(options.plan, frame)) as file:
            plan = json.load(file)
        if options.supersample == AUTO:
            manner.supersample = plan.get("center_supersample", 1)
        check_plan(plan, shot_of(scene, eyes[0], manner.supersample).size,
                   manner.supersample)
        return views_of_plan(plan)

    if options.plan and manner.supersample == AUTO:
        manner.supersample = 1  # until views_at() knows it
    folder, count = folder_of(options.output), Count()
    render_now(scene, views_steps(
        scene, frames_of(options, scene), folder, views_at, eyes, manner,
        count, options.frames is not None, say))
    rolling = shutter_options(scene, manner.shutter, folder)
    if rolling:
        say("the shutter rolls: give dof-gather %s" % " ".join(rolling))
    tell(costs.in_words(count.paths))
    print("sparselens_views.py: %s in %s" % (counted(count.rendered, "view"),
                                             options.output))


def main(options, say):
    scene = bpy.context.scene
    eyes = chosen_eyes(scene, options.eye)
    if options.samples:
        scene.cycles.samples = options.samples
        scene.eevee.taa_render_samples = options.samples
    manner = Manner(options.overscan, options.multilayer, options.layer,
                    options.supersample,
                    0 if options.picture else options.finish,
                    slices=options.slices, layers=options.layers,
                    shutter=options.shutter)
    if not options.picture:
        return render_views(options, scene, eyes, manner, say)
    manner.keep = not options.again
    made = Pictures(scene, eyes, manner, options, say)
    render_now(scene, made.steps(frames_of(options, scene)))
    tell(made.cost)
    print("sparselens:", made.words())


def run(arguments, command=False):
    """Returns the exit code. Catches all exceptions, because Blender would
    continue after one and end with 0."""
    name = "sparselens" if command else "sparselens_views.py"
    try:
        options = read_options(arguments, command)
        main(options, lambda text: print("%s: warning: %s" % (name, text),
                                         file=sys.stderr))
    except SystemExit as ended:  # by argparse
        return ended.code
    except (ValueError, OSError, RuntimeError) as error:
        print("%s: error: %s" % (name, error), file=sys.stderr)
        return 1
    except Exception:
        traceback.print_exc()
        return 1
    return 0


def run_as_script():
    after = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    registers = not hasattr(bpy.types.Scene, "sparselens")
    if registers:
        panel.register()  # for the panel's looks, which the file holds
    code = run(sys.argv[after:])
    if registers:
        panel.unregister()  # Blender's module does not end well without
    sys.exit(code)


def run_as_command(arguments):
    return run(arguments, command=True)
