"""Renders what sparselens needs of a Blender scene: the centre view and views from the rim of the lens.

As a script:
    blender -b scene.blend -P sparselens_views.py -- -o DIR [--views N] [--plan PLAN.json] [--frame N] [--samples N]
        [--lens-views N]
As an add-on: install this file under Preferences > Add-ons; the panel is in the camera's properties.

The scene's camera says all: focal length, sensor, depth of field (focus distance or object, f-stop). Depth of field
itself is switched off while rendering; each view is a pinhole picture, its camera moved in its own plane by the
aperture's radius, focal length / (2 f-number). Works with Cycles and EEVEE. Files: DIR/center.exr and DIR/view_K.exr,
RGBA (half) and Z (float, planar), with the camera in the EXR attributes that ldi-warp reads. With a plan of ldi-plan
only its rectangles are rendered, one file each: DIR/view_K_R.exr.

--lens-views adds DIR/lens_KKKK.exr, views spread evenly over the whole lens: their average (dof-accumulate --center
DIR/center.exr) is what a renderer without depth of field of its own would have to make.

Then, in a shell:
    ldi-warp DIR/center.exr DIR/view_*.exr -o - | ldi-cluster - -o - | dof-gather - -o defocused.exr
"""

bl_info = {
    "name": "sparselens views",
    "author": "sparselens",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Camera > sparselens",
    "description": "Renders the views that sparselens makes depth of field from",
    "category": "Render",
}

import argparse
import json
import math
import os
import struct
import sys

import bpy
from mathutils import Matrix, Vector


# --- EXR attributes -------------------------------------------------------------------------------------------------


def attribute(name, kind, value):
    """One header attribute: name and type end with a zero byte, then the size and the bytes, little endian."""
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def float_attribute(name, value):
    return attribute(name, "float", struct.pack("<f", value))


def matrix_attribute(name, matrix):
    """EXR multiplies row vectors, Blender column vectors: the transpose is written."""
    return attribute(name, "m44f", struct.pack("<16f", *[matrix[row][column] for column in range(4) for row in range(4)]))


def header_end(data):
    """Position of the zero byte that ends the header of a file of one part, and whether its pixels are tiled."""
    version = struct.unpack_from("<i", data, 4)[0]
    if data[:4] != b"\x76\x2f\x31\x01" or version & 0x1800:
        raise ValueError("is no flat EXR of one part")
    at, chunks = 8, {}
    while data[at] != 0:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        size = struct.unpack_from("<i", data, type_end + 1)[0]
        chunks[data[at:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    return at, chunks


def rows_a_chunk(compression):
    return {0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32, 9: 256}[compression]


def add_attributes(path, attributes):
    """Puts attributes into the header of a scanline EXR; the offsets behind it move along."""
    with open(path, "rb") as file:
        data = file.read()
    end, header = header_end(data)
    window = struct.unpack("<4i", header["dataWindow"])
    chunks = -(-(window[3] - window[1] + 1) // rows_a_chunk(header["compression"][0]))
    extra = b"".join(attributes)
    offsets = struct.unpack_from("<%dQ" % chunks, data, end + 1)
    moved = struct.pack("<%dQ" % chunks, *[offset + len(extra) for offset in offsets])
    with open(path + ".partial", "wb") as file:
        file.write(data[:end] + extra + b"\0" + moved + data[end + 1 + 8 * chunks:])
    os.replace(path + ".partial", path)


# --- The camera -----------------------------------------------------------------------------------------------------


class Lens:
    """What the scene's camera says of its lens, in Blender's units, which Cycles takes for metres."""

    def __init__(self, scene):
        camera = scene.camera
        data, render = camera.data, scene.render
        if data.type != "PERSP":
            raise ValueError("camera '%s' is not a perspective one" % camera.name)
        width = render.resolution_x * render.resolution_percentage // 100
        height = render.resolution_y * render.resolution_percentage // 100
        aspect = render.pixel_aspect_y / render.pixel_aspect_x
        by_height = data.sensor_fit == "VERTICAL" or (data.sensor_fit == "AUTO" and width < height * aspect)
        sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
        self.focal_length = data.lens
        self.sensor_width = sensor * width / (height * aspect) if by_height else sensor
        self.shift = (data.shift_x, data.shift_y)
        self.fstop = data.dof.aperture_fstop
        self.radius = data.lens / 1000 / (2 * self.fstop)
        self.size = (width, height)
        self.pixel_aspect = aspect
        self.focus_distance = data.dof.focus_distance
        if data.dof.focus_object:
            towards = camera.matrix_world.inverted() @ data.dof.focus_object.matrix_world.translation
            self.focus_distance = -towards.z

    def world_to_camera(self, matrix_world):
        """Camera space of the EXR attribute: x right, y up, looking along -z, as Blender's own."""
        return matrix_world.inverted()

    def attributes(self, matrix_world):
        return [
            float_attribute("pinholeFocalLength", self.focal_length),
            float_attribute("aperture", self.fstop),
            float_attribute("focus", self.focus_distance),
            float_attribute("sparselens:sensorWidth", self.sensor_width),
            float_attribute("sparselens:metresPerUnit", 1.0),
            matrix_attribute("worldToCamera", self.world_to_camera(matrix_world)),
        ]


# --- Rendering ------------------------------------------------------------------------------------------------------


class PinholeSetting:
    """Depth of field off, EXR with Z on; afterwards everything is as it was."""

    def __init__(self, scene):
        self.scene = scene

    def __enter__(self):
        scene = self.scene
        render, settings = scene.render, scene.render.image_settings
        self.kept = [(scene.camera.data.dof, "use_dof"), (scene.camera, "matrix_world"), (scene, "camera"),
                     (render, "filepath"), (render, "use_border"), (render, "use_crop_to_border"),
                     (render, "border_min_x"), (render, "border_min_y"), (render, "border_max_x"),
                     (render, "border_max_y"), (render, "use_compositing"), (render, "use_sequencer"),
                     (settings, "file_format"), (settings, "color_mode"), (settings, "color_depth"),
                     (settings, "use_zbuffer"), (settings, "exr_codec")]
        self.values = [getattr(thing, name) for thing, name in self.kept]
        self.values = [value.copy() if isinstance(value, Matrix) else value for value in self.values]
        self.passes = [(layer, layer.use_pass_z) for layer in scene.view_layers]
        scene.camera.data.dof.use_dof = False
        render.use_compositing = render.use_sequencer = render.use_border = False
        settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "16"
        settings.use_zbuffer, settings.exr_codec = True, "ZIP"
        for layer in scene.view_layers:
            layer.use_pass_z = True
        return self

    def __exit__(self, *_):
        for (thing, name), value in zip(self.kept, self.values):
            setattr(thing, name, value)
        for layer, use in self.passes:
            layer.use_pass_z = use

    def render(self, path, lens, home, u, box=None):
        """One view from lens point u (x right, y up); box: pixels x0, y0, x1, y1, y down, corners included."""
        scene, render = self.scene, self.scene.render
        scene.camera.matrix_world = home @ Matrix.Translation(Vector((lens.radius * u[0], lens.radius * u[1], 0)))
        render.use_border = box is not None
        render.use_crop_to_border = False
        if box:
            width, height = lens.size
            render.border_min_x, render.border_max_x = box[0] / width, (box[2] + 1) / width
            render.border_min_y, render.border_max_y = 1 - (box[3] + 1) / height, 1 - box[1] / height
        render.filepath = os.path.abspath(path)
        bpy.ops.render.render(write_still=True, scene=scene.name)
        add_attributes(render.filepath, lens.attributes(scene.camera.matrix_world))


def rim_points(count):
    return [(math.cos(2 * math.pi * k / count), math.sin(2 * math.pi * k / count)) for k in range(count)]


def spiral_points(count):
    """Even in area over the lens: the golden angle, as sunflowers do."""
    golden = math.pi * (3 - math.sqrt(5))
    polar = [(math.sqrt((k + 0.5) / count), k * golden) for k in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for radius, angle in polar]


def set_samples(scene, samples):
    scene.cycles.samples = scene.eevee.taa_render_samples = samples


def render_views(scene, folder, views=4, plan=None, lens_views=0):
    """Renders into `folder`; with a plan just what it asks for, without the centre view it was made from."""
    lens, home = Lens(scene), scene.camera.matrix_world.copy()
    os.makedirs(folder, exist_ok=True)
    with PinholeSetting(scene) as setting:
        if plan:
            for view in plan["views"]:
                for number, box in enumerate(view["rectangles"]):
                    name = "%s_%d.exr" % (view["name"], number)
                    setting.render(os.path.join(folder, name), lens, home, view["lens_point"], box)
            return
        setting.render(os.path.join(folder, "center.exr"), lens, home, (0, 0))
        for number, u in enumerate(rim_points(views)):
            setting.render(os.path.join(folder, "view_%d.exr" % number), lens, home, u)
        for number, u in enumerate(spiral_points(lens_views)):
            setting.render(os.path.join(folder, "lens_%04d.exr" % number), lens, home, u)


# --- Add-on ---------------------------------------------------------------------------------------------------------


class SPARSELENS_OT_render_views(bpy.types.Operator):
    """Render the centre view and the views from the rim of the lens"""

    bl_idname = "sparselens.render_views"
    bl_label = "Render Views"

    def execute(self, context):
        scene = context.scene
        try:
            render_views(scene, bpy.path.abspath(scene.sparselens_folder), scene.sparselens_views)
        except (ValueError, OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class SPARSELENS_PT_panel(bpy.types.Panel):
    bl_label = "sparselens"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "data"

    @classmethod
    def poll(cls, context):
        return context.camera is not None

    def draw(self, context):
        self.layout.prop(context.scene, "sparselens_folder")
        self.layout.prop(context.scene, "sparselens_views")
        self.layout.operator("sparselens.render_views")


def register():
    bpy.types.Scene.sparselens_folder = bpy.props.StringProperty(
        name="Folder", description="Where the views go", subtype="DIR_PATH", default="//views/")
    bpy.types.Scene.sparselens_views = bpy.props.IntProperty(
        name="Rim views", description="Views from the rim of the lens", default=4, min=0, max=64)
    bpy.utils.register_class(SPARSELENS_OT_render_views)
    bpy.utils.register_class(SPARSELENS_PT_panel)


def unregister():
    bpy.utils.unregister_class(SPARSELENS_PT_panel)
    bpy.utils.unregister_class(SPARSELENS_OT_render_views)
    del bpy.types.Scene.sparselens_folder, bpy.types.Scene.sparselens_views


def main(arguments):
    parser = argparse.ArgumentParser(prog="sparselens_views.py")
    parser.add_argument("-o", "--output", required=True, metavar="DIR")
    parser.add_argument("--views", type=int, default=4, metavar="N")
    parser.add_argument("--plan", metavar="PLAN.json")
    parser.add_argument("--lens-views", type=int, default=0, metavar="N")
    parser.add_argument("--samples", type=int, metavar="N", help="a pixel; else the scene's own")
    parser.add_argument("--frame", type=int, metavar="N")
    options = parser.parse_args(arguments)
    scene = bpy.context.scene
    if options.frame is not None:
        scene.frame_set(options.frame)
    plan = None
    if options.plan:
        with open(options.plan) as file:
            plan = json.load(file)
    if options.samples:
        set_samples(scene, options.samples)
    render_views(scene, options.output, options.views, plan, options.lens_views)


if __name__ == "__main__" and "--" in sys.argv:
    try:
        main(sys.argv[sys.argv.index("--") + 1:])
    except (ValueError, OSError, RuntimeError) as error:
        print("sparselens_views.py:", error, file=sys.stderr)
        sys.exit(1)
