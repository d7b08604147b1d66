"""A small scene for the tests of share/blender, and the pictures for comparison.

    blender -b -P scene.py -- CYCLES|BLENDER_EEVEE WIDTHxHEIGHT save FILE.blend
    blender -b FILE.blend -P scene.py -- CYCLES WIDTHxHEIGHT truth SAMPLES OUT.exr        the camera's own depth of field
    blender -b FILE.blend -P scene.py -- ENGINE WIDTHxHEIGHT defocus VIEW.exr DEPTH.exr OUT_PREFIX FSTOP ...
"""

import math
import sys
import time

import bpy


def material(name, colours, scale):
    """A checker, mapped by object coordinates."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    checker, coordinates = nodes.new("ShaderNodeTexChecker"), nodes.new("ShaderNodeTexCoord")
    checker.inputs["Scale"].default_value = scale
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = colours
    links.new(coordinates.outputs["Object"], checker.inputs["Vector"])
    shader = nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 1
    shader.inputs["Specular" if bpy.app.version < (4, 0) else "Specular IOR Level"].default_value = 0
    links.new(checker.outputs["Color"], shader.inputs["Base Color"])
    return made


def engine_named(engine):
    """EEVEE had another name from Blender 4.2 to 4.5."""
    renamed = engine == "BLENDER_EEVEE" and (4, 2) <= bpy.app.version < (5, 0)
    return "BLENDER_EEVEE_NEXT" if renamed else engine


def build(engine, size, path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = engine_named(engine)
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"  # names the files' colours, too, which are unnamed in an empty file
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 64, False, False
    scene.cycles.max_bounces = 2
    scene.eevee.taa_render_samples = 16
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.35, 0.45, 0.7, 1)
    scene.world = world

    floor = material("floor", ((0.8, 0.75, 0.7, 1), (0.2, 0.25, 0.3, 1)), 1.0)
    wall = material("wall", ((0.9, 0.7, 0.2, 1), (0.2, 0.3, 0.7, 1)), 1.5)
    red = material("red", ((0.9, 0.2, 0.15, 1), (0.95, 0.9, 0.85, 1)), 8)
    green = material("green", ((0.1, 0.6, 0.2, 1), (0.6, 0.8, 0.3, 1)), 6)
    dark = material("dark", ((0.05, 0.05, 0.06, 1), (0.1, 0.1, 0.1, 1)), 30)

    def give(made):
        bpy.context.object.data.materials.append(made)

    bpy.ops.mesh.primitive_plane_add(size=60, location=(0, 20, 0))
    give(floor)
    bpy.ops.mesh.primitive_plane_add(size=60, location=(0, 14, 0), rotation=(math.pi / 2, 0, 0))
    give(wall)
    for x, y, z, r, made in ((0, 4, 0.7, 0.7, red), (1.7, 7, 0.9, 0.9, green), (-1.8, 3.1, 0.5, 0.5, green),
                             (-2.6, 10, 1.4, 1.4, red), (1.1, 2.6, 0.3, 0.3, red)):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=r, location=(x, y, z))
        bpy.ops.object.shade_smooth()
        give(made)
    for i in range(9):
        bpy.ops.mesh.primitive_cube_add(size=1, location=(-0.62 + 0.16 * i, 1.5, 0.55))
        bpy.context.object.scale = (0.012, 0.012, 0.55)
        give(dark)
    bpy.ops.object.light_add(type="SUN", rotation=(0.7, 0.3, 0.2))
    bpy.context.object.data.energy, bpy.context.object.data.angle = 3, 0.05

    bpy.ops.object.camera_add(location=(0, 0, 0.8), rotation=(math.pi / 2, 0, 0))
    scene.camera = bpy.context.object
    camera = scene.camera.data
    camera.lens, camera.sensor_width = 50, 36
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 4, 0.5
    bpy.ops.wm.save_as_mainfile(filepath=path)


def exr(scene, path):
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "16"
    scene.render.filepath = path


def truth(scene, samples, path):
    scene.cycles.samples = samples
    exr(scene, path)
    bpy.ops.render.render(write_still=True)


def defocus(scene, view, depth, prefix, fstops):
    """Blurs a view with the Defocus node once for each f-stop; prints the seconds of each. `depth`: an EXR whose R, G
    and B are depths, because the Image node does not read Z of a plain EXR."""
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    image, z, node, out = (tree.nodes.new(kind) for kind in ("CompositorNodeImage", "CompositorNodeImage",
                                                             "CompositorNodeDefocus", "CompositorNodeComposite"))
    image.image, z.image = bpy.data.images.load(view), bpy.data.images.load(depth)
    z.image.colorspace_settings.name = "Non-Color"
    node.use_zbuffer, node.use_preview, node.scene, node.blur_max = True, False, scene, 100
    tree.links.new(image.outputs["Image"], node.inputs["Image"])
    tree.links.new(z.outputs["Image"], node.inputs["Z"])
    tree.links.new(node.outputs["Image"], out.inputs["Image"])
    for fstop in fstops:
        node.f_stop = fstop
        exr(scene, prefix + str(fstop) + ".exr")
        started = time.time()
        bpy.ops.render.render(write_still=True)
        print("DEFOCUS", fstop, time.time() - started)


def main(engine, size, action, *rest):
    size = tuple(int(side) for side in size.split("x"))
    if action == "save":
        return build(engine, size, rest[0])
    scene = bpy.context.scene
    scene.render.engine = engine_named(engine)
    scene.render.resolution_x, scene.render.resolution_y = size
    if action == "truth":
        return truth(scene, int(rest[0]), rest[1])
    return defocus(scene, *rest[:3], [float(value) for value in rest[3:]])


main(*sys.argv[sys.argv.index("--") + 1:])
