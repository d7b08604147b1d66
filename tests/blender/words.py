"""Checks that all that the panel says names its fields, and no option: each option in a message of a module that the
panel's operators import is a field's, and each option of the tools is one, or goes into Other Options.

    blender -b -P words.py -- FOLDER OPTION...        the options of dof-gather
"""

import ast
import os
import re
import sys

import bpy

OPTION = re.compile(r"(?<![\w-])--([a-z][a-z-]+)")
OF_THE_COMMAND_LINE = {"command.py", "options.py"}  # nothing else says what they say
ONLY_OF_THE_SCRIPT = {"plan", "tools"}


def check(true, text):
    if not true:
        sys.exit("words.py: %s" % text)


def messages(path):
    """The texts that are raised or said: of ValueError and other errors, say, warn and warnings.append."""
    with open(path, encoding="utf-8") as file:
        tree = ast.parse(file.read())
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name.endswith(("Error", "NoTool")) or name in ("say", "warn", "append", "report"):
                for part in ast.walk(node):
                    if isinstance(part, ast.Constant) and isinstance(part.value, str):
                        yield part.value


def main(folder, *of_gather):
    sys.path.insert(0, folder)
    import sparselens_blender as addon
    from sparselens_blender import options, words
    addon.register()
    settings, package = bpy.context.scene.sparselens, os.path.dirname(addon.__file__)

    # Each field has its option: those of the settings that the script has, and all looks.
    of_script = {action.dest for action in parser_of(options)._actions}
    for prop in settings.bl_rna.properties:
        if prop.identifier in of_script - {"looks"}:
            said = words.in_panel("--%s 3" % prop.identifier.replace("_", "-"))
            check(said == '"%s" 3' % prop.name, "%s is called %s" % (prop.name, said))
    for prop in settings.lens_looks.bl_rna.properties:
        if prop.identifier not in ("rna_type", "name"):
            said = words.in_panel("--%s: x" % prop.identifier.replace("_", "-"))
            check(said == '"%s": x' % prop.name, "%s is called %s" % (prop.name, said))

    # So have the fields of Blender's camera.
    for owner, names in ((bpy.types.Camera, ("focal-length=lens", "sensor-width=sensor_width")),
                         (bpy.types.CameraDOFSettings, (
                             "fstop=aperture_fstop", "focus-distance=focus_distance", "blades=aperture_blades",
                             "blade-rotation=aperture_rotation", "squeeze=aperture_ratio"))):
        for option, name in (pair.split("=") for pair in names):
            check(words.field_of(option) == owner.bl_rna.properties[name].name, "%s: %s" % (option, words.field_of(option)))

    # Each option in a message is a field's, or one of dof-gather.
    found = 0
    for name in sorted(os.listdir(package)):
        if name.endswith(".py") and name not in OF_THE_COMMAND_LINE:
            for text in messages(os.path.join(package, name)):
                for option in OPTION.findall(text):
                    found += 1
                    said, field = words.in_panel(text), words.field_of(option)
                    check('"%s"' % field in said if field else '--%s' % option in said and '"Other Options"' in said
                          if option in of_gather else option in ONLY_OF_THE_SCRIPT and "Other" not in said, "%s: %s" % (name, said))
    check(found >= 12, "only %d options are in messages" % found)

    # The options of the tool are fields, or other options.
    for option in of_gather:
        said = words.in_panel("dof-gather: --%s: no" % option)
        check('"' in said and (words.field_of(option) is None) == ('"Other Options"' in said), said)
    settings.looks = "--cat-eye 7"
    check(words.in_panel("dof-gather: --cat-eye: no") == 'dof-gather: --cat-eye in "Other Options": no', "typed")
    settings.looks = ""

    # The messages of C++ that name an option or a document.
    for text, expected in {
            'ldi-warp: warning: a.exr: 3 % speckles; if it is smoke or fog, render it by itself (docs/renderers.md, '
            '"Smoke and fog"; in Blender, --slices 8)':
            'ldi-warp: warning: a.exr: 3 % speckles; if it is smoke or fog, render it by itself (in Blender, '
            '"Slices of Volumes" 8)',
            "hold one out by the other (--holdout; docs/comp.md)":
            'hold one out by the other (--holdout in "Other Options")',
            "give dof-gather --region 30,17,89,50": 'give dof-gather --region 30,17,89,50 in "Other Options"',
            "choose one by --layer": 'choose one by "Use for Rendering"',
            "stands still: --shutter 4 renders": 'stands still: "Moments of Shutter" 4 renders',
            "ldi-warp: a.exr: --view 0,0.06 is": "ldi-warp: a.exr: --view 0,0.06 is",
            "name their folder there (or on the command line by --tools)": "name their folder there",
            "name their folder by --tools": "name their folder by --tools on the command line",
            OSError(28, "No space left on device", "/full/a.exr"): "/full/a.exr: No space left on device"}.items():
        check(words.in_panel(text) == expected, "%s: %s" % (text, words.in_panel(text)))
    addon.unregister()


def parser_of(options):
    """The script's parser, by asking for nothing."""
    import argparse
    made = argparse.ArgumentParser()
    options.add_options(made.add_argument, made.add_mutually_exclusive_group)
    options.add_picture_options(made.add_argument)
    return made


main(*sys.argv[sys.argv.index("--") + 1:])
