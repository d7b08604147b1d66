"""The node group of the compositor that reads the pictures."""

import os

import bpy

from .renders import folder_of
from .shots import eyes_of

NAME = "Sparse lens"


def pictures_of(scene, eye):
    """The linear picture of the current frame, and whether its name has the
    frame's number. A picture of Render Animation comes before one of Take
    Picture."""
    folder = folder_of(scene.sparselens.folder)
    numbered = os.path.join(folder, "picture%s.%04d.exr" % (
        eye.file_suffix, scene.frame_current))
    alone = os.path.join(folder, "picture%s.exr" % eye.file_suffix)
    output = os.path.splitext(bpy.path.abspath(
        scene.render.frame_path(frame=scene.frame_current)))[0]
    for path, several in ((numbered, True),
                          (output + eye.file_suffix + ".exr", True),
                          (alone, False)):
        if os.path.exists(path):
            return path, several
    raise ValueError("%s is not there: press Take Picture or Render Animation"
                     % alone)


def image_of(path, several):
    image = bpy.data.images.load(path, check_existing=True)
    image.source = "SEQUENCE" if several else "FILE"
    return image


def add_output(group, name):
    if hasattr(group, "interface"):  # since Blender 4
        group.interface.new_socket(name, in_out="OUTPUT",
                                   socket_type="NodeSocketColor")
    else:
        group.outputs.new("NodeSocketColor", name)


def group_of(scene):
    """Remakes the group in place; nodes that use it stay linked."""
    group = bpy.data.node_groups.get(NAME)
    if group is None:
        group = bpy.data.node_groups.new(NAME, "CompositorNodeTree")
    eyes = eyes_of(scene)
    sources = [pictures_of(scene, eye) for eye in eyes]
    group.nodes.clear()
    out = group.nodes.new("NodeGroupOutput")
    out.location.x = 300
    for number, (eye, (path, several)) in enumerate(zip(eyes, sources)):
        name = "Image" if len(eyes) == 1 else "Image " + eye.name
        if name not in [socket.name for socket in out.inputs]:
            add_output(group, name)
        node = group.nodes.new("CompositorNodeImage")
        node.location.y = -300 * number
        node.image = image_of(path, several)
        if several:  # the file's number is the frame's
            node.frame_start, node.frame_duration = 1, scene.frame_end
            node.use_auto_refresh = True
        colours = (node.outputs.get("Image")
                   or node.outputs["Combined"])  # of a file with passes
        group.links.new(colours, out.inputs[name])
    return group
