"""What the tools and the script say, in the words of the panel: names of
fields in the place of options.
"""

import argparse
import re
import shlex

import bpy

from . import options

# The names that Blender shows for the values of these options. The panel's own
# settings and looks are not listed: field_of() finds them by their properties.
ELSEWHERE = {
    "blades": "Blades", "blade-rotation": "Rotation", "squeeze": "Ratio",
    "fstop": "F-Stop", "focus-distance": "Focus Distance",
    "focal-length": "Focal Length", "sensor-width": "Sensor Width",
    "layer": "Use for Rendering", "samples": "Max Samples",
    "rolling-shutter": "Rolling Shutter", "shutter-curve": "Shutter Curve",
    "again": "Keep Views"}

OPTION = re.compile(r"(?<![\w-])--([a-z][a-z-]*)((?: | ?= ?)[\d.,-]+)?")


def field_of(option):
    """The name of the field that has this option's value; None if the option
    may only be among the other options of dof-gather."""
    settings = bpy.types.Scene.bl_rna.properties["sparselens"].fixed_type
    looks = settings.properties["lens_looks"].fixed_type
    for group in settings, looks:
        found = group.properties.get(option.replace("-", "_"))
        if found is not None and option not in ("looks", "lens-looks"):
            return found.name
    return ELSEWHERE.get(option)


def options_of_script():
    parser = argparse.ArgumentParser()
    options.add_options(parser.add_argument,
                        parser.add_mutually_exclusive_group)
    options.add_views_options(parser.add_argument)
    options.add_picture_options(parser.add_argument)
    return parser.parse_known_args(["-o", ""])[0]


def options_typed():
    typed = bpy.context.scene.sparselens.looks
    try:
        return {word.split("=")[0] for word in shlex.split(typed)}
    except ValueError:
        return set()


def in_panel(said):
    """The text, or the error, for somebody who has no command line."""
    if isinstance(said, OSError) and said.filename and said.strerror:
        said = "%s: %s" % (said.filename, said.strerror)
    typed = options_typed()

    def renamed(found):
        name = field_of(found[1])
        if name and "--" + found[1] not in typed:
            return '"%s"%s' % (name, found[2] or "")
        if of_views:
            return found[0]
        if not of_gather and hasattr(script, found[1].replace("-", "_")):
            return "%s on the command line" % found[0]
        return '%s in "Other Options"' % found[0]

    text = re.sub(r"\(docs/[\w.]+(?:, \"[^\"]*\")?(?:; )?", "(", str(said))
    text = re.sub(r"; docs/[\w.]+(?=\))", "", text)
    text = re.sub(r" \((?:or on the command line by [^)]*)?\)", "", text)
    of_views = text.startswith(("ldi-warp: ", "ldi-cluster: "))
    of_gather, script = text.startswith("dof-gather: "), options_of_script()
    return OPTION.sub(renamed, text)


def report(operator, kind, said):
    operator.report({kind}, in_panel(said))
