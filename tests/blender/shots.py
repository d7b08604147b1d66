"""Makes pictures of variants of ../shared/shots as --picture does, at a quarter of their width and height, and renders
them with Cycles' own lens.

    blender -b BASE.blend -P shots.py -- FOLDER VARIANTS OUT TOOLS NAME...
        FOLDER: share/blender; VARIANTS: the folder of the variants' scripts. Writes OUT/NAME.exr, OUT/NAME.true.exr,
        or for a stereo scene OUT/NAME_L.exr, ...; and OUT/NAME.said, with the exit code in its last line
"""

import contextlib
import os
import sys

import bpy


def shrink(scene):
    """The lens is twice as wide, so that the blur is not less than a pixel of the small picture."""
    scene.render.resolution_x //= 4
    scene.render.resolution_y //= 4
    scene.camera.data.dof.aperture_fstop /= 2


def render_truth(scene, path):
    """Twice as many rays as the views have together, with other noise."""
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "16"
    scene.cycles.samples, scene.cycles.seed, scene.cycles.use_denoising = 160, 77, False
    scene.camera.data.dof.use_dof, scene.render.filepath = True, path
    bpy.ops.render.render(write_still=True)


def main(folder, variants, out, tools, *names):
    sys.path.insert(0, folder)
    from sparselens_blender import command, panel
    panel.register()
    base = bpy.data.filepath
    for name in names:
        bpy.ops.wm.open_mainfile(filepath=base)
        if name != "static":
            with open(os.path.join(variants, name + ".py")) as file:
                exec(compile(file.read(), name, "exec"), {"__name__": name})
        scene = bpy.context.scene
        shrink(scene)
        scene.frame_set(12)
        with open(os.path.join(out, name + ".said"), "w") as said, contextlib.redirect_stderr(said):
            code = command.run(["--picture", "-o", os.path.join(out, name + ".exr"), "--views-folder",
                                os.path.join(out, name), "--samples", "16", "--tools", tools])
            print("exit code", code, file=said)
        if code == 0:
            render_truth(bpy.context.scene, os.path.join(out, name + ".true.exr"))
    panel.unregister()


main(*sys.argv[sys.argv.index("--") + 1:])
