"""Variants of the scene of scene.py for the tests of share/blender.

    blender -b SCENE.blend -P variants.py -- KIND[,KIND...] OUT.blend
        KIND: a function below whose name begins with make_
    blender -b SCENE.blend -P variants.py -- each KIND[,KIND...] ...
        the same several times: KIND[,KIND...].blend beside the scene
    blender -b SCENE.blend -P variants.py -- render SAMPLES FIRST LAST OUT.####.exr
        the frames as Blender itself renders them; with several eyes OUT.####_L.exr and OUT.####_R.exr; `render_depth`
        writes depth, too, which takes a multilayer file since Blender 4.0
    blender -b SCENE.blend -P variants.py -- border SAMPLES FRAME X,Y,WIDTH,HEIGHT FOLDER
        two renders of Blender's border, y down: black_K.####.exr, and with Crop crop_K.####.exr
"""

import math
import os
import sys

import bpy
from mathutils import Matrix

LAST = 6  # frame at which every motion ends


def key(thing, prop, first, last):
    """Two keys, at the frames 1 and LAST."""
    for frame, value in ((1, first), (LAST, last)):
        setattr(thing, prop, value)
        thing.keyframe_insert(prop, frame=frame)


def empty(scene, name, location):
    made = bpy.data.objects.new(name, None)
    made.location = location
    scene.collection.objects.link(made)
    return made


def make_keys(scene, camera):
    key(camera, "location", (0, 0, 0.8), (0.35, 0.1, 0.9))
    key(camera, "rotation_euler", (math.pi / 2, 0, 0), (math.pi / 2 - 0.01, 0.03, 0.04))


def make_path(scene, camera):
    curve = bpy.data.curves.new("path", "CURVE")
    curve.dimensions, curve.path_duration = "3D", LAST - 1
    spline = curve.splines.new("POLY")
    spline.points.add(2)
    for point, place in zip(spline.points, ((0, 0, 0.8), (0.2, 0.05, 0.85), (0.35, 0, 0.95))):
        point.co = (*place, 1)
    path = bpy.data.objects.new("path", curve)
    scene.collection.objects.link(path)
    camera.location = 0, 0, 0
    follow = camera.constraints.new("FOLLOW_PATH")
    follow.target, follow.use_fixed_location = path, True
    key(follow, "offset_factor", 0, 1)


def make_track(scene, camera):
    key(camera, "location", (0, 0, 0.8), (0.5, 0.1, 1.0))
    track = camera.constraints.new("TRACK_TO")
    track.target = empty(scene, "target", (0, 4, 0.8))
    track.track_axis, track.up_axis = "TRACK_NEGATIVE_Z", "UP_Y"


def make_driver(scene, camera):
    """An expression so simple that Blender needs no permission to run scripts."""
    camera.driver_add("location", 0).driver.expression = "frame * 0.05"


def make_child(scene, camera):
    """A parent that moves, turns and is scaled, and a Child Of on top of it."""
    parent, other = empty(scene, "parent", (0, 0, 0)), empty(scene, "other", (0, 0, 0))
    camera.parent = parent
    parent.scale = 2, 2, 2
    camera.location.z = 0.4
    key(parent, "rotation_euler", (0, 0, 0), (0, 0, 0.05))
    key(other, "location", (0, 0, 0), (0.3, 0, 0))
    camera.constraints.new("CHILD_OF").target = other


def make_marker(scene, camera):
    """A marker at frame 3 cuts to another camera."""
    other = bpy.data.objects.new("other", camera.data.copy())
    scene.collection.objects.link(other)
    other.matrix_world = Matrix.Translation((0.3, 0.1, 0)) @ camera.matrix_world
    for frame, bound in ((1, camera), (3, other)):
        scene.timeline_markers.new(bound.name, frame=frame).camera = bound


def make_lens(scene, camera):
    """Zoom, f-stop, lens shift and focus pulled; the focus is an object's."""
    target = empty(scene, "target", (0, 3, 0.8))
    camera.data.dof.focus_object = target
    key(camera.data, "lens", 40, 60)
    key(camera.data, "shift_x", 0, 0.05)
    key(camera.data.dof, "aperture_fstop", 0.5, 0.7)
    key(target, "location", (0.5, 3, 0.8), (0.5, 5, 0.8))


def curves_of(action):
    """In Blender 5 they are in layers."""
    if hasattr(action, "fcurves"):
        return action.fcurves
    return action.layers[0].strips[0].channelbags[0].fcurves


def straight(thing):
    """Makes the motion between the keys even."""
    for curve in curves_of(thing.animation_data.action):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def make_pan(scene, camera):
    """The camera turns, with the motion blur of half a frame: 13 pixels of 320."""
    key(camera, "rotation_euler", (math.pi / 2, 0, 0.15), (math.pi / 2, 0, -0.15))
    straight(camera)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5


def make_spin(scene, camera):
    """The ball turns by 0.2 in the frame, and a post in front of it by 0.1."""
    for name, turn in (("Sphere", 2), ("Cube.003", 1)):
        thing = scene.objects[name]
        x, y, z = thing.rotation_euler
        key(thing, "rotation_euler", (x, y - turn / 2, z), (x, y + turn / 2, z))
        straight(thing)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5


def make_film(scene, camera):
    """Without the wall: behind the floor's edge there is nothing."""
    bpy.data.objects.remove(scene.objects["Plane.001"])
    scene.render.film_transparent = True


def make_ball(scene, camera):
    """Only the ball in focus; light and shadows from the others stay."""
    scene.render.film_transparent = True
    for thing in scene.objects:
        thing.visible_camera = thing.name == "Sphere"


def make_others(scene, camera):
    scene.objects["Sphere"].visible_camera = False


def make_framing(scene, camera):
    """Properties that move the picture's edges: shift, fit, non-square pixels, a percentage."""
    camera.data.shift_x, camera.data.shift_y = 0.06, -0.04
    camera.data.sensor_fit, camera.data.sensor_height = "VERTICAL", 20
    scene.render.pixel_aspect_x = 1.25
    scene.render.resolution_percentage = 80


def make_pinhole(scene, camera):
    camera.data.dof.use_dof = False


def make_passes(scene, camera):
    layer = scene.view_layers[0]
    layer.use_pass_normal = layer.use_pass_diffuse_color = layer.use_pass_cryptomatte_object = True


def make_layers(scene, camera):
    """The posts in their own view layer, for pictures that are combined later."""
    posts = bpy.data.collections.new("posts")
    scene.collection.children.link(posts)
    for made in list(bpy.data.objects):
        if made.name.startswith("Cube"):
            scene.collection.objects.unlink(made)
            posts.objects.link(made)
    back = scene.view_layers[0]
    front = scene.view_layers.new("front")
    back.name = "back"
    back.layer_collection.children["posts"].exclude = True
    rest = bpy.data.collections.new("rest")
    scene.collection.children.link(rest)
    for made in list(scene.collection.objects):
        if made.type == "MESH":
            scene.collection.objects.unlink(made)
            rest.objects.link(made)
    front.layer_collection.children["rest"].exclude = True
    for layer in (back, front):
        layer.use_pass_z = layer.use_pass_cryptomatte_object = True
    scene.render.film_transparent = True


def volume_cube(scene, name, kind, density, centre, size, colour):
    """A cube that holds nothing but an even volume."""
    bpy.ops.mesh.primitive_cube_add(size=1, location=centre)
    cube = bpy.context.object
    cube.name, cube.scale = name, size
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    volume = nodes.new("ShaderNodeVolume" + kind)
    volume.inputs["Color"].default_value = (*colour, 1)
    volume.inputs["Density"].default_value = density
    made.node_tree.links.new(volume.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    cube.data.materials.append(made)


def make_soot(scene, camera):
    """Black volumes of 0.5 a unit from the depths 5 to 7, and of 0.2 from 10 to 13, before the wall alone."""
    for thing in list(scene.objects):
        if thing.type == "MESH" and thing.name != "Plane.001":
            bpy.data.objects.remove(thing)
    for name, density, near, far in ("near", 0.5, 5, 7), ("far", 0.2, 10, 13):
        volume_cube(scene, name, "Absorption", density, (0, (near + far) / 2, 0.8), (40, far - near, 40), (0, 0, 0))


def make_smoke(scene, camera):
    """Smoke with the balls and the floor in it; the near ball stands before it."""
    volume_cube(scene, "smoke", "Scatter", 0.25, (0, 6.5, 1), (8, 5, 4), (0.9, 0.9, 0.9))


def make_sheet(scene, camera):
    """A sheet that covers half of what is behind it, in the right half of the picture. It lights and shades nothing."""
    bpy.ops.mesh.primitive_plane_add(size=2, location=(1.15, 2, 0.8), rotation=(math.pi / 2, 0, 0))
    sheet = bpy.context.object
    sheet.name = "Thin sheet"
    sheet.visible_diffuse = sheet.visible_glossy = sheet.visible_shadow = False
    made = bpy.data.materials.new("sheet")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    mix, out = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeOutputMaterial")
    mix.inputs[0].default_value = 0.5
    links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    links.new(nodes.new("ShaderNodeEmission").outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], out.inputs["Surface"])
    sheet.data.materials.append(made)


def make_homeless(scene, camera):
    scene.camera = None


def make_panorama(scene, camera):
    camera.data.type = "PANO"


def make_mesh(scene, camera):
    scene.camera = scene.objects["Sphere"]


def make_wide(scene, camera):
    """An f-stop that is keyed down to 0."""
    key(camera.data.dof, "aperture_fstop", 0.5, 0)


def make_macro(scene, camera):
    camera.data.dof.focus_distance = 0


def make_unlayered(scene, camera):
    scene.view_layers[0].use = False


def make_workbench(scene, camera):
    scene.render.engine = "BLENDER_WORKBENCH"


def make_denoised(scene, camera):
    scene.cycles.use_denoising = True


def make_blades(scene, camera):
    """An aperture that is not round."""
    dof = camera.data.dof
    dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 5, 0.3, 1.5


def make_seeded(scene, camera):
    """A seed for each frame, by keys."""
    scene.cycles.seed = 1
    scene.cycles.keyframe_insert("seed", frame=1)


def make_region(scene, camera):
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.26, 0.74, 0.2, 0.9


def make_held_collection(scene, camera):
    """A collection that is a holdout, within one that is not."""
    outer, held = bpy.data.collections.new("outer"), bpy.data.collections.new("held")
    scene.collection.children.link(outer)
    outer.children.link(held)
    held.objects.link(scene.objects["Sphere"])
    scene.view_layers[0].layer_collection.children["outer"].children["held"].holdout = True


def make_held_object(scene, camera):
    scene.objects["Sphere"].is_holdout = True


def make_held_material(scene, camera):
    scene.objects["Sphere"].active_material.node_tree.nodes.new("ShaderNodeHoldout")


def make_unheld(scene, camera):
    """Holdouts that are not rendered: without an object, excluded, hidden."""
    for name in "empty", "excluded":
        made = bpy.data.collections.new(name)
        scene.collection.children.link(made)
        scene.view_layers[0].layer_collection.children[name].holdout = True
    made.objects.link(bpy.data.objects.new("apart", scene.objects["Sphere"].data))
    scene.view_layers[0].layer_collection.children["excluded"].exclude = True
    scene.objects["Sphere.001"].is_holdout = scene.objects["Sphere.001"].hide_render = True


def stereo(mode, pivot):
    def make(scene, camera):
        scene.render.use_multiview = True
        data = camera.data.stereo
        data.convergence_mode, data.pivot = mode, pivot
        data.interocular_distance, data.convergence_distance = 0.2, 3
    return make


make_offaxis, make_parallel = stereo("OFFAXIS", "CENTER"), stereo("PARALLEL", "RIGHT")
make_offaxis_left, make_toe = stereo("OFFAXIS", "LEFT"), stereo("TOE", "CENTER")
make_toe_left = stereo("TOE", "LEFT")


def make_toe_rim(scene, camera):
    """Eyes as far apart as the middle of the lens is from its rim."""
    make_toe(scene, camera)
    camera.data.stereo.interocular_distance = 0.05


def make_cameras(scene, camera):
    """A camera for each eye."""
    other = bpy.data.objects.new("Camera_R", camera.data.copy())
    scene.collection.objects.link(other)
    other.matrix_world = Matrix.Translation((0.2, 0, 0.05)) @ camera.matrix_world
    camera.name = "Camera_L"
    scene.render.use_multiview, scene.render.views_format = True, "MULTIVIEW"


def make_eevee(scene, camera):
    scene.render.engine = "BLENDER_EEVEE_NEXT" if (4, 2) <= bpy.app.version < (5, 0) else "BLENDER_EEVEE"


def make_still(scene, camera):
    """Puts a camera without animation in place of the scene's, with the lens that it has at frame 4."""
    scene.frame_set(4)
    seen = scene.camera.evaluated_get(bpy.context.evaluated_depsgraph_get())
    made = bpy.data.objects.new("still", bpy.data.cameras.new("still"))
    scene.collection.objects.link(made)
    made.matrix_world = seen.matrix_world.normalized()
    for name in ("lens", "sensor_width", "sensor_height", "sensor_fit", "shift_x", "shift_y"):
        setattr(made.data, name, getattr(seen.data, name))
    made.data.dof.aperture_fstop = seen.data.dof.aperture_fstop
    made.data.dof.focus_distance = seen.data.dof.focus_distance
    if seen.data.dof.focus_object:
        target = seen.data.dof.focus_object.matrix_world.translation
        made.data.dof.focus_distance = -(seen.matrix_world.normalized().inverted() @ target).z
    scene.timeline_markers.clear()
    scene.camera = made


def render(scene, depth, samples, first, last, path):
    settings = scene.render.image_settings
    if depth and bpy.app.version >= (5, 0):
        settings.media_type, settings.use_exr_interleave = "MULTI_LAYER_IMAGE", True
    settings.file_format = "OPEN_EXR_MULTILAYER" if depth and bpy.app.version >= (4, 0) else "OPEN_EXR"
    settings.color_mode, settings.color_depth = "RGBA", "16"
    scene.view_layers[0].use_pass_z = True
    if depth and bpy.app.version < (4, 0):
        settings.use_zbuffer = True
    scene.cycles.samples = samples
    for frame in range(first, last + 1):
        scene.frame_set(frame)
        scene.render.filepath = path.replace("####", "%04d" % frame)
        bpy.ops.render.render(write_still=True)


def border(scene, samples, frame, box, folder):
    made = scene.render
    x, y, width, height = [int(number) for number in box.split(",")]
    made.use_border = True
    made.border_min_x, made.border_max_x = (x + 0.25) / made.resolution_x, (x + width + 0.25) / made.resolution_x
    bottom = made.resolution_y - y - height
    made.border_min_y, made.border_max_y = (bottom + 0.25) / made.resolution_y, (bottom + height + 0.25) / made.resolution_y
    for kind in "black", "crop":
        made.use_crop_to_border = kind == "crop"
        for half in 1, 2:
            scene.cycles.seed = 100 + half
            render(scene, False, int(samples), int(frame), int(frame), os.path.join(folder, "%s_%d.####.exr" % (kind, half)))


def save(kinds, path):
    scene = bpy.context.scene
    for kind in kinds.split(","):
        globals()["make_" + kind](scene, scene.camera)
    bpy.ops.wm.save_as_mainfile(filepath=path)


def main(action, *rest):
    scene = bpy.context.scene
    if action in ("render", "render_depth"):
        return render(scene, action == "render_depth", *[int(number) for number in rest[:3]], rest[3])
    if action == "border":
        return border(scene, *rest)
    if action != "each":
        return save(action, rest[0])
    base = bpy.data.filepath
    folder = os.path.dirname(base)
    for kinds in rest:
        before, _, last = kinds.rpartition(",")
        saved = os.path.join(folder, before + ".blend")
        begun = before and os.path.exists(saved)  # a still camera shows what Blender evaluates after loading
        bpy.ops.wm.open_mainfile(filepath=saved if begun else base)
        save(last if begun else kinds, os.path.join(folder, kinds + ".blend"))


main(*sys.argv[sys.argv.index("--") + 1:])
