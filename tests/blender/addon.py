"""Runs the add-on on a scene with unusual settings, and fails if one of them is changed afterwards.

    blender -b SCENE.blend -P addon.py -- FOLDER DIR [auto]
        auto: with automatic overscan
"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from state import changes, state  # noqa: E402


class Recorder:
    """Replaces a layout, to record which settings and buttons the panel shows."""

    def __init__(self):
        self.shown = []

    def prop(self, settings, name):
        self.shown.append(settings.bl_rna.properties[name].identifier)

    def operator(self, name):
        self.shown.append(name)

    def label(self, text, icon="NONE"):
        self.shown.append(text)


def draw_panel(addon):
    """Draws the panel, because nothing does without windows."""
    if not addon.panel.SPARSELENS_PT_panel.is_registered:
        sys.exit("the panel is not registered")
    panel = type("Panel", (), {"layout": Recorder()})()
    scene = bpy.context.scene
    context = type("Context", (), {"scene": scene, "camera": scene.camera.data})
    addon.panel.SPARSELENS_PT_panel.draw(panel, context)
    if any("scene's camera" in text for text in panel.layout.shown):
        sys.exit("the panel of the scene's camera names another: %s" % panel.layout.shown)
    context.camera, panel.layout = None, Recorder()
    addon.panel.SPARSELENS_PT_panel.draw(panel, context)
    if "Views are those of the scene's camera, %s" % scene.camera.name not in panel.layout.shown:
        sys.exit("the panel of another camera does not say so: %s" % panel.layout.shown)
    buttons = [name for name in panel.layout.shown if name.startswith("sparselens.")]
    if "overscan_auto" not in panel.layout.shown or buttons != [
            "sparselens.render_views", "sparselens.take_picture", "sparselens.finish",
            "sparselens.render_animation", "sparselens.make_nodes"]:
        sys.exit("the panel shows %s" % panel.layout.shown)


def main(path, folder, overscan=""):
    sys.path.insert(0, path)
    import sparselens_blender as addon
    addon.register()
    draw_panel(addon)

    scene = bpy.context.scene
    scene.frame_set(3)
    scene.cycles.samples = 2
    files, render = scene.render.image_settings, scene.render
    files.color_depth = "16"
    files.file_format = "JPEG"
    render.use_border, render.border_min_x, render.use_stamp = True, 0.25, True
    render.filepath, render.resolution_x, render.resolution_percentage = "//mine", 48, 200
    render.resolution_y = 27
    scene.sparselens.folder, scene.sparselens.overscan = folder, 3
    scene.sparselens.overscan_auto = overscan == "auto"

    before = state(scene)
    if bpy.ops.sparselens.render_views() != {"FINISHED"}:
        sys.exit("the add-on rendered nothing")
    found = changes(before, state(scene))
    addon.unregister()
    if found:
        sys.exit("changed: %s" % found[:20])


main(*sys.argv[sys.argv.index("--") + 1:])
