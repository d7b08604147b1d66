"""Replaces `blender -b` by the module bpy from PyPI, so that the tests of share/blender run in other releases:

    tests/blender/bpy.sh 4.2.0 BIN_DIR pictures.sh

Accepts the options that those tests give Blender: FILE.blend, -P, --python-expr, --python-exit-code, in order, and as the
last one --command sparselens, for which it enables the installed extension.
"""

import runpy
import sys
import traceback


def run(words):
    import bpy  # reads its own arguments
    exit_code = 0
    words = iter(words)
    for word in words:
        if word == "--":
            return
        if word in ("-b", "--factory-startup"):
            continue
        if word == "--command":
            import addon_utils
            module = addon_utils.enable("bl_ext.user_default." + next(words) + "_blender")
            sys.exit(module.command.run_as_command(list(words)) if module else 1)
        if word == "--python-exit-code":
            exit_code = int(next(words))
            continue
        try:
            if word == "-P":
                runpy.run_path(next(words), run_name="__main__")
            elif word == "--python-expr":
                exec(next(words), {"__name__": "__main__"})
            elif word.endswith(".blend"):
                bpy.ops.wm.open_mainfile(filepath=word)
            else:
                sys.exit("as_blender.py: unknown: %s" % word)
        except Exception:
            traceback.print_exc()
            if exit_code:
                sys.exit(exit_code)


words = sys.argv[1:]
sys.argv = ["blender"] + words
run(words)
