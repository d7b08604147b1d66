"""Runs the Defocus node of Blender's compositor (bpy from PyPI) on the centre view in the current folder."""
import pathlib
import time

import bpy
import numpy
import OpenEXR
from common import Centre, keep_best, write

centre = Centre()
write("colour.exr", centre.rgb)
write("depth.exr", numpy.repeat(centre.z[..., None].clip(0, 1e6), 3, axis=2))
write("radii.exr", numpy.repeat(abs(centre.radii())[..., None], 3, axis=2))

scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = centre.width, centre.height, 100
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = str(pathlib.Path("made.exr").absolute())
eye = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(eye)
scene.camera = eye
eye.data.lens, eye.data.sensor_width, eye.data.sensor_fit = centre.camera["focal_mm"], centre.camera["sensor_width_mm"], "HORIZONTAL"
eye.data.dof.use_dof, eye.data.dof.focus_distance = True, centre.camera["focus_distance"]

if hasattr(scene, "compositing_node_group"):  # Blender 5
    tree = bpy.data.node_groups.new("defocus", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    scene.compositing_node_group = tree
    result = tree.nodes.new("NodeGroupOutput")
else:
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    result = tree.nodes.new("CompositorNodeComposite")
if hasattr(scene.render, "compositor_device"):
    scene.render.compositor_device = "CPU"


def image(file):
    node = tree.nodes.new("CompositorNodeImage")
    node.image = bpy.data.images.load(str(pathlib.Path(file).absolute()))
    node.image.colorspace_settings.is_data = True
    return node.outputs[0]


node = tree.nodes.new("CompositorNodeDefocus")
tree.links.new(image("colour.exr"), node.inputs[0])
depth, radii = image("depth.exr"), image("radii.exr")
tree.links.new(node.outputs[0], result.inputs[0])
node.bokeh, node.blur_max, node.scene = "CIRCLE", 3 * abs(centre.radii()).max(), scene
if hasattr(node, "threshold"):
    node.threshold, node.use_preview, node.use_gamma_correction = 0, False, False


def tried(what, depths, fstop, larger):
    tree.links.new(depths, node.inputs[1])
    node.use_zbuffer, node.f_stop, node.z_scale = depths is depth, fstop, larger
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    seconds = time.perf_counter() - start
    with OpenEXR.File("made.exr", separate_channels=True) as file:
        made = numpy.stack([file.channels()[name].pixels for name in "RGB"], axis=2)
    return what, made, seconds


# Tries the f-stop of our lens radius, in metres per scene unit, and some near it, because the node's lens differs from
# ours.
fstop = centre.camera["focal_mm"] / 2000 / centre.camera["lens_radius"]
ways = [(f"Z, f/{fstop * by:.3g}", depth, fstop * by, 1) for by in (0.6, 0.75, 1, 1.4)]
ways += [(f"radii x {by}", radii, 128, by) for by in (0.8, 1, 1.25, 1.6)]
keep_best("Blender-Defocus", (tried(*way) for way in ways))
