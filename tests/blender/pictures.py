"""Presses the add-on's buttons without a window, and fails if something is wrong.

    blender -b SCENE.blend -P pictures.py -- FOLDER VIEWS ACTION...
        render: renders the views into VIEWS; take: takes the picture; finish: finishes it; focus D, fstop N, blades N:
        sets the lens; frame N;
        rename: gives the scene, the camera and its lens other names; camera NAME: uses this camera, which is made,
        a little apart, if it is not there; scene NAME: shows this scene, which is made with its own camera and folder;
        reload FILE.blend: saves the file under this name, and opens it; move: moves the camera; refuse PATTERN: taking
        the picture gives this error, on one line; refuse-finish, refuse-render, refuse-animate PATTERN: finishing, rendering
        and Render Animation do; stop: begins a render and a picture, and stops both; follow D WIDTH: takes the picture, and lets it follow a new focus distance by a draft
        of this width; animate NAME: makes frames 1 and 2;
        compose FILE.exr: writes the output of the node group;
        set NAME=VALUE: sets a field of the panel, such as views=3 or lens_looks.cat_eye=0.5, or keys it:
        NAME=VALUE@FRAME; save FILE.blend
"""

import os
import re
import struct
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from state import changes, state  # noqa: E402


def check(true, text):
    if not true:
        sys.exit("pictures.py: %s" % text)


class Unchanged:
    """Checks that the scene is unchanged afterwards."""

    def __enter__(self):
        self.before = state(bpy.context.scene)

    def __exit__(self, *error):
        found = changes(self.before, state(bpy.context.scene))
        check(not found, "changed: %s" % found[:20])


def said_by(operator):
    try:
        with Unchanged():
            return "" if operator() == {"FINISHED"} else "cancelled"
    except RuntimeError as error:
        return str(error)


def image_of():
    name = bpy.context.scene.name
    found = [image for image in bpy.data.images if image.get("sparselens") == name]
    check(len(found) == 1 and found[0].name == "sparselens, " + name, "images of %s: %s" % (name, found))
    images = [image for image in bpy.data.images if image.get("sparselens")]
    check(all(image["sparselens"] in bpy.data.scenes for image in images), "an image is of no scene: %s" % images)
    return found[0]


def render():
    check(said_by(bpy.ops.sparselens.render_views) == "", "no views")


def take():
    said = said_by(bpy.ops.sparselens.take_picture)
    check(said == "", "no picture: %s" % said)
    scene, image = bpy.context.scene, image_of()
    if scene.view_layers[0].aovs:
        return  # an image with passes has no size
    check(tuple(image.size) == (scene.render.resolution_x, scene.render.resolution_y),
          "the image has %s pixels" % str(tuple(image.size)))
    check(image.has_data or image.pixels[0] >= 0, "the image has no pixels")


def finish():
    said = said_by(bpy.ops.sparselens.finish)
    check(said == "", "not finished: %s" % said)
    check(image_of().filepath.endswith("picture.exr"), "the image shows %s" % image_of().filepath)


REFUSERS = {"refuse": "take_picture", "refuse-finish": "finish", "refuse-render": "render_views",
            "refuse-animate": "render_animation"}


def refuse(pattern, operator):
    said = said_by(getattr(bpy.ops.sparselens, operator))
    check(re.fullmatch("Error: [^\n]*%s[^\n]*\n?" % pattern, said), "not '%s': %s" % (pattern, said))


def rename():
    scene = bpy.context.scene
    scene.name, scene.camera.name, scene.camera.data.name = "Renamed", "Hero", "Prime"
    scene.view_layers[0].name = "Beauty"


def use_camera(name):
    scene = bpy.context.scene
    if name not in scene.objects:
        other = bpy.data.objects.new(name, scene.camera.data.copy())
        other.matrix_world = scene.camera.matrix_world.copy()
        other.location.x += 0.3
        scene.collection.objects.link(other)
    scene.camera = scene.objects[name]
    bpy.context.view_layer.update()


def show_scene(name):
    scene = bpy.data.scenes.get(name)
    if scene is None:
        scene = bpy.context.scene.copy()  # with its collections and settings
        scene.name, scene.sparselens.folder = name, scene.sparselens.folder + "-" + name
        scene.camera = bpy.context.scene.camera.copy()
        scene.camera.data = scene.camera.data.copy()
        scene.collection.objects.link(scene.camera)
        scene.camera.location.x += 0.3
    bpy.context.window.scene = scene
    bpy.context.view_layer.update()


def stop(addon):
    """Stops as Esc does, which needs a window: tests/blender/window.sh presses it."""
    scene = bpy.context.scene
    files = sorted(os.listdir(scene.sparselens.folder))
    with Unchanged():
        views = [("center", (0, 0), None)]
        rendering = addon.chunked.Rendering(scene, addon.renders.views_steps(
            scene, [scene.frame_current], scene.sparselens.folder, lambda frame: views, addon.shots.eyes_of(scene),
            addon.manner.Manner(overscan=0, supersample=1), addon.manner.Count()))
        rendering.begin()
        next(rendering.steps)
        check(scene.camera.name == "sparselens view", "the render has not begun")
        rendering.end()
    with Unchanged():
        taking = addon.render_job.PictureJob(scene, draft=True)
        while taking.chain is None or taking.chain.process is None:
            check(not taking.tick(), "nothing is left to stop")
        process = taking.chain.process
        taking.stop()
        check(process.poll() is not None, "the tool goes on")
        check(taking.tick(), "a stopped picture begins again")
    check(sorted(os.listdir(scene.sparselens.folder)) == files, "left are %s" % os.listdir(scene.sparselens.folder))


def follow(addon, distance, width):
    """Does by hand what Blender's timer does."""
    scene = bpy.context.scene
    take()
    made = os.path.join(scene.sparselens.folder, "picture.exr")
    follower = addon.render_job.Follower(addon.render_job.lens_state(scene))
    follower.tick(scene)
    check(follower.job is None, "an unchanged lens takes a picture")
    scene.camera.data.dof.focus_distance = float(distance)
    shown, began, drafted = [], time.time(), 0
    while follower.job or not shown:
        check(time.time() - began < 100 and ": warning: " in (follower.message or ": warning: "),
              "following: %s" % follower.message)
        follower.tick(scene)
        path = image_of().filepath
        if path not in shown[-1:]:
            shown.append(path)
        if path != made:
            drafted = struct.unpack("<4i", addon.kept.header_of(path)["displayWindow"][1])[2] + 1
        time.sleep(0.01)
    check([path == made for path in shown[-2:]] == [False, True], "a draft and then the picture: %s" % shown)
    check(tuple(image_of().size) == (96, 54), "the picture's size: %s" % str(tuple(image_of().size)))
    check(drafted == int(width), "the draft is %d pixels wide, not %s" % (drafted, width))


def compose(path):
    """The compositor's output for the node group alone, as an EXR."""
    check(said_by(bpy.ops.sparselens.make_nodes) == "", "no node group")
    check(said_by(bpy.ops.sparselens.make_nodes) == "", "no node group a second time")
    scene, group = bpy.context.scene, bpy.data.node_groups["Sparse lens"]
    check([node.bl_idname for node in group.nodes].count("CompositorNodeImage") == 1, "made twice")
    if bpy.app.version < (5, 0):
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        out = tree.nodes.new("CompositorNodeComposite")
    else:
        tree = scene.compositing_node_group = bpy.data.node_groups.new("composed", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        out = tree.nodes.new("NodeGroupOutput")
    node = tree.nodes.new("CompositorNodeGroup")
    node.node_tree = group
    tree.links.new(node.outputs["Image"], out.inputs["Image"])
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def main(folder, views, *actions):
    sys.path.insert(0, folder)
    import sparselens_blender as addon
    addon.register()
    scene = bpy.context.scene
    scene.cycles.samples = 4
    scene.sparselens.folder, scene.sparselens.views = views, 2
    scene.sparselens.overscan_auto, scene.sparselens.overscan = False, 4
    scene.sparselens.supersample_auto = False
    if bpy.app.version >= (4, 2):  # Blender 5 changes it with the format of the files
        scene.render.image_settings.linear_colorspace_settings.name = "ACEScg"
    actions = list(actions)
    while actions:
        scene, action = bpy.context.scene, actions.pop(0)
        if action == "render":
            render()
        elif action == "take":
            take()
        elif action == "focus":
            scene.camera.data.dof.focus_distance = float(actions.pop(0))
        elif action == "fstop":
            scene.camera.data.dof.aperture_fstop = float(actions.pop(0))
        elif action == "blades":
            dof = scene.camera.data.dof
            dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = int(actions.pop(0)), 0.3, 1.5
        elif action == "frame":
            scene.frame_set(int(actions.pop(0)))
        elif action == "move":
            scene.camera.location.x += 0.1
            bpy.context.view_layer.update()
        elif action == "rename":
            rename()
        elif action == "camera":
            use_camera(actions.pop(0))
        elif action == "scene":
            show_scene(actions.pop(0))
        elif action == "reload":  # into this file
            addon.render_job.start_following(addon.render_job.lens_state(scene))
            bpy.ops.wm.save_as_mainfile(filepath=actions.pop(0))
            bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
            check(addon.render_job.follower is None, "another file is followed")
        elif action == "save":
            bpy.ops.wm.save_as_mainfile(filepath=actions.pop(0), copy=True)
        elif action == "compose":
            compose(actions.pop(0))
        elif action == "finish":
            finish()
        elif action in REFUSERS:
            refuse(actions.pop(0), REFUSERS[action])
        elif action == "stop":
            stop(addon)
        elif action == "animate":  # into this file, without an ending
            scene.render.filepath, scene.frame_end = actions.pop(0), 2
            check(said_by(bpy.ops.sparselens.render_animation) == "", "no animation")
        elif action == "follow":
            follow(addon, actions.pop(0), actions.pop(0))
        elif action == "set":
            name, value = actions.pop(0).split("=")
            owner = scene.sparselens
            while "." in name:
                group, name = name.split(".", 1)
                owner = getattr(owner, group)
            value, _, frame = value.partition("@")
            setattr(owner, name, eval(value))
            if frame:
                owner.keyframe_insert(name, frame=int(frame))
        else:
            sys.exit("pictures.py: unknown: %s" % action)
    addon.unregister()


main(*sys.argv[sys.argv.index("--") + 1:])
