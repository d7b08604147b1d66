"""Renders what sparselens needs of a Blender scene: the centre view and views
from the rim of the lens.

As a script:
    blender -b shot.blend -P sparselens_views.py -- -o DIR [--help]
As an add-on: install this file under Preferences > Add-ons; the panel is in
the camera's properties.

Each view is a pinhole picture. It is rendered through a camera that this
script makes, and which stands where the scene's camera stands at that frame,
moved in the plane of the lens by the radius of the lens, focal length /
(2 f-number). Nothing animates the made camera, so the render cannot move it;
the scene's own camera is only read, after keys, drivers and constraints have
been evaluated. Works with Cycles and EEVEE.

README.md, beside this file, says what is written.
"""

bl_info = {
    "name": "sparselens views",
    "author": "sparselens",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Camera > sparselens",
    "description": "Renders the views that sparselens makes depth of field of",
    "category": "Render",
}

import argparse
import json
import math
import os
import re
import struct
import sys
import traceback
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import bpy
from mathutils import Matrix


# --- EXR headers -------------------------------------------------------------


def exr_int(value):
    return "int", struct.pack("<i", value)


def exr_text(value):
    return "string", value.encode()


def exr_float(value):
    return "float", struct.pack("<f", value)


def exr_point(x, y):
    return "v2f", struct.pack("<2f", x, y)


def exr_box(x, y, width, height):
    """A window of pixels; y points down, the last pixel is included."""
    corners = x, y, x + width - 1, y + height - 1
    return "box2i", struct.pack("<4i", *corners)


def exr_matrix(matrix):
    """EXR multiplies row vectors, Blender columns: write the transpose."""
    return "m44f", struct.pack("<16f", *[x for row in matrix.transposed()
                                         for x in row])


def read_header(data):
    """The attributes of an EXR of one part, {name: (type, bytes)}, and the
    position behind the header."""
    magic, version = struct.unpack_from("<2i", data)
    if magic != 20000630 or version & 0x1a00:
        raise ValueError("not a flat scanline EXR of one part")
    at, attributes = 8, {}
    while data[at] != 0:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        start = type_end + 5
        end = start + struct.unpack_from("<i", data, type_end + 1)[0]
        attributes[data[at:name_end].decode()] = (
            data[name_end + 1:type_end].decode(), data[start:end])
        at = end
    return attributes, at + 1


def header_bytes(data, attributes):
    """Magic number and version as in `data`, then the attributes."""
    parts = [data[:8]]
    for name, (kind, value) in attributes.items():
        parts += [name.encode(), b"\0", kind.encode(), b"\0",
                  struct.pack("<i", len(value)), value]
    return b"".join(parts) + b"\0"


ROWS_A_CHUNK = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32,
                9: 256}  # by the number of the compression


def channel_list(header):
    """Names of the channels, and the bytes behind each name: 4 of type, 4
    flags, 8 sampling."""
    packed, at, found = header["channels"][1], 0, []
    while packed[at] != 0:
        name_end = packed.index(b"\0", at)
        found.append((packed[at:name_end].decode(),
                      packed[name_end + 1:name_end + 17]))
        at = name_end + 17
    return found


PLAIN_NAMES = ["A", "B", "G", "R", "Z"]


def name_plainly(header):
    """Where an EXR holds no more than colour and depth, their channels lose
    the names of the view layer and its passes: A, B, G, R, Z, which are in
    the same order."""
    channels = channel_list(header)
    if [name.rsplit(".", 1)[-1] for name, _ in channels] != PLAIN_NAMES:
        return
    header["channels"] = "chlist", b"".join(
        plain.encode() + b"\0" + rest
        for plain, (_, rest) in zip(PLAIN_NAMES, channels)) + b"\0"
    header.pop("BlenderMultiChannel", None)


def with_attributes(data, attributes, plain=False):
    """The bytes of an EXR with these attributes added or replaced, and with
    `plain` names of its channels. The chunks are kept; their table of offsets
    moves, and so do their rows where the data window does."""
    header, end = read_header(data)
    if plain:
        name_plainly(header)
    _, top, _, bottom = struct.unpack("<4i", header["dataWindow"][1])
    rows = ROWS_A_CHUNK[header["compression"][1][0]]
    count = (bottom - top) // rows + 1
    header.update(attributes)
    down = struct.unpack("<4i", header["dataWindow"][1])[1] - top

    start = header_bytes(data, header)
    moved = len(start) - end
    offsets = struct.unpack_from("<%dQ" % count, data, end)
    result = bytearray(start + data[end:])
    struct.pack_into("<%dQ" % count, result, len(start),
                     *[offset + moved for offset in offsets])
    for offset in offsets:
        row = struct.unpack_from("<i", data, offset)[0]
        struct.pack_into("<i", result, offset + moved, row + down)
    return bytes(result)


def depth_rows(data):
    """The rows of the depth of an EXR without compression, from the top."""
    header, end = read_header(data)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"][1])
    before = 0
    for name, rest in channel_list(header):
        if name == "Z" or name.endswith(".Depth.Z"):
            break
        before += 2 if struct.unpack_from("<i", rest)[0] == 1 else 4
    else:
        raise ValueError("an EXR without depth")
    width = right - left + 1
    offsets = struct.unpack_from("<%dQ" % (bottom - top + 1), data, end)
    return [struct.unpack_from("<%df" % width, data,
                               offset + 8 + before * width)
            for offset in offsets]


# --- The camera at a frame ---------------------------------------------------


@dataclass
class Shot:
    """What the scene's camera is at one frame, for one eye, after animation,
    drivers and constraints. Blender's units, which Cycles takes for metres."""

    camera: str            # its name
    placement: Matrix      # from camera to world, without a scale
    size: tuple            # of the picture, pixels
    pixel_aspect: float    # width of a pixel over its height
    focal_length: float    # mm
    sensor_width: float    # mm, across the picture
    shift: tuple           # right and up, in widths of the picture
    clip: tuple            # nearest and farthest depth
    fstop: float
    focus_distance: float
    blades: int            # 0: a round aperture
    rotation: float        # of the blades, radians
    ratio: float           # 1: round; 2: twice as high as wide
    supersample: int       # pixels of `size`, across and down, in one of the
                           # scene's picture
    pixel_filter: str      # of the picture, as ldi.pixelFilter has it

    @property
    def lens_radius(self):
        return self.focal_length / 1000 / (2 * self.fstop)

    def blur_radius(self, depth):
        """Of a point's circle of confusion, in pixels across."""
        focal_length = self.focal_length * self.size[0] / self.sensor_width
        return (self.lens_radius * focal_length / self.focus_distance
                * abs(depth - self.focus_distance) / depth)


@dataclass
class Eye:
    """A view of a stereo scene, or the only one."""

    name: str = ""
    file_suffix: str = ""
    camera_suffix: str = ""
    side: int = 0  # of a stereo pair made of one camera: -1 left, 1 right


def eyes_of(scene):
    """The eyes that the scene asks for, as its Stereoscopy panel has it."""
    render = scene.render
    if not render.use_multiview:
        return [Eye()]
    if render.views_format == "MULTIVIEW":
        return [Eye(view.name, view.file_suffix, view.camera_suffix)
                for view in render.views if view.use]
    return [Eye(view.name, view.file_suffix,
                side=-1 if view.name == "left" else 1)
            for view in render.stereo_views if view.use]


def camera_of(scene, eye):
    """The camera object of an eye. The cameras of a multi-view scene differ
    in the end of their names."""
    camera = scene.camera
    if camera is None:
        raise ValueError("scene '%s' has no camera: set one in the scene's "
                         "properties" % scene.name)
    endings = [view.camera_suffix for view in scene.render.views]
    endings = [end for end in endings if camera.name.endswith(end)]
    if eye.camera_suffix and endings:
        longest = max(endings, key=len)
        base = camera.name[:len(camera.name) - len(longest)]
        return scene.objects.get(base + eye.camera_suffix, camera)
    return camera


def without_scale(matrix):
    result = matrix.to_3x3()
    for column in range(3):
        result.col[column] = result.col[column].normalized()
    return Matrix.Translation(matrix.translation) @ result.to_4x4()


def stereo_offset(stereo, side):
    """Where an eye of a stereo pair stands in the space of its camera."""
    centred = stereo.pivot == "CENTER"
    if not centred and side == (-1 if stereo.pivot == "LEFT" else 1):
        return Matrix()
    distance = side * stereo.interocular_distance * (0.5 if centred else 1)
    move = Matrix.Translation((distance, 0, 0))
    if stereo.convergence_mode != "TOE":
        return move
    turn = Matrix.Rotation(
        side * math.atan(stereo.interocular_distance / 2
                         / stereo.convergence_distance), 4, "Y")
    return move @ turn if centred else turn @ move @ turn


def stereo_shift(data, side):
    """What an eye of an off-axis stereo pair adds to the lens shift, in
    Blender's unit of that, which is a sensor width here whatever the fit."""
    stereo = data.stereo
    if side == 0 or stereo.convergence_mode != "OFFAXIS":
        return 0
    moved = stereo_offset(stereo, side).translation.x
    return -moved / data.sensor_width * data.lens / stereo.convergence_distance


def focus_distance_of(data, placement, depsgraph):
    """Depth of the plane of focus; that of the focus object, or of its bone,
    where there is one."""
    target = data.dof.focus_object
    if target is None:
        return data.dof.focus_distance
    target = target.evaluated_get(depsgraph)
    matrix = target.matrix_world
    bone = data.dof.focus_subtarget
    if bone and target.pose and bone in target.pose.bones:
        matrix = matrix @ target.pose.bones[bone].matrix
    return abs((placement.inverted() @ matrix.translation).z)


def picture_size(render):
    return (render.resolution_x * render.resolution_percentage // 100,
            render.resolution_y * render.resolution_percentage // 100)


def border_box(render):
    """The render region in pixels: x0, y0, x1, y1, y down, corners included,
    as Blender rounds it."""
    width, height = picture_size(render)
    left, right = [int(x * width) for x in (render.border_min_x,
                                            render.border_max_x)]
    bottom, top = [int(y * height) for y in (render.border_min_y,
                                             render.border_max_y)]
    return left, height - top, right - 1, height - bottom - 1


def pixel_filter_of(scene):
    """The filter of the scene's engine and its width, as ldi.pixelFilter has
    them. EEVEE's is Cycles' default one."""
    if scene.render.engine != "CYCLES":
        return "blackman-harris:%g" % scene.render.filter_size
    name = {"BOX": "box", "GAUSSIAN": "gaussian",
            "BLACKMAN_HARRIS": "blackman-harris"}[
                scene.cycles.pixel_filter_type]
    return name if name == "box" else "%s:%g" % (name,
                                                 scene.cycles.filter_width)


def shot_of(scene, eye, supersample=1):
    """The camera of an eye at the scene's current frame."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera = camera_of(scene, eye).evaluated_get(depsgraph)
    data, render = camera.data, scene.render
    if camera.type != "CAMERA":
        raise ValueError("the scene's camera is '%s', which is no camera but "
                         "of type %s: set a camera in the scene's properties"
                         % (camera.name, camera.type))
    if data.type != "PERSP":
        raise ValueError("camera '%s' is not a perspective one: set its lens "
                         "to Perspective" % camera.name)
    if eye.side and data.stereo.use_spherical_stereo:
        raise ValueError("camera '%s' has spherical stereo, whose views do "
                         "not stand on one lens: switch it off" % camera.name)
    width, height = picture_size(render)
    square_height = height * render.pixel_aspect_y / render.pixel_aspect_x
    fit = data.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if width >= square_height else "VERTICAL"
    by_height = fit == "VERTICAL"
    sensor = (data.sensor_height if data.sensor_fit == "VERTICAL"
              else data.sensor_width)
    fitted = square_height if by_height else width  # pixels of `sensor`

    placement = without_scale(camera.matrix_world)
    if eye.side:
        placement = placement @ stereo_offset(data.stereo, eye.side)
    focus_distance = focus_distance_of(data, placement, depsgraph)
    for name, value in (("f-stop", data.dof.aperture_fstop),
                        ("focus distance", focus_distance)):
        if not value > 0:
            raise ValueError("camera '%s' has %s 0 at frame %d: set one above "
                             "0 in its depth of field" % (
                                 camera.name, name, scene.frame_current))
    shift = data.shift_x + stereo_shift(data, eye.side), data.shift_y
    return Shot(
        camera=camera.name, placement=placement,
        size=(width * supersample, height * supersample),
        pixel_aspect=render.pixel_aspect_x / render.pixel_aspect_y,
        focal_length=data.lens, sensor_width=sensor * width / fitted,
        shift=(shift[0] * fitted / width, shift[1] * fitted / width),
        clip=(data.clip_start, data.clip_end), fstop=data.dof.aperture_fstop,
        focus_distance=focus_distance,
        blades=data.dof.aperture_blades, rotation=data.dof.aperture_rotation,
        ratio=data.dof.aperture_ratio, supersample=supersample,
        pixel_filter=pixel_filter_of(scene))


def camera_attributes(shot, placement):
    """The EXR attributes of a view. Camera space in EXR: x right, y up, z
    forward, where Blender's z points backward."""
    field = shot.sensor_width / shot.focal_length
    to_camera = Matrix.Diagonal((1, 1, -1, 1)) @ placement.inverted()
    subpixels = {} if shot.supersample == 1 else {
        "ldi.supersample": exr_int(shot.supersample),
        "ldi.pixelFilter": exr_text(shot.pixel_filter),
    }
    return subpixels | {
        "Camera": exr_text(shot.camera),
        "pinholeFocalLength": exr_float(shot.focal_length),
        "aperture": exr_float(shot.fstop),
        "focus": exr_float(shot.focus_distance),
        "worldToCamera": exr_matrix(to_camera),
        "screenWindowWidth": exr_float(field),
        "screenWindowCenter": exr_point(shot.shift[0] * field,
                                        shot.shift[1] * field),
        "pixelAspectRatio": exr_float(shot.pixel_aspect),
        "sparselens:sensorWidth": exr_float(shot.sensor_width),
        "sparselens:metresPerUnit": exr_float(1),
        "aperture_blades": exr_int(shot.blades),
        "aperture_rotation": exr_float(shot.rotation),
        "aperture_ratio": exr_float(shot.ratio),
    }


# --- What a scene asks for ---------------------------------------------------


def parts_of(collection):
    """A view layer's collection and all within, but for what is excluded."""
    if not collection.exclude:
        yield collection
        for child in collection.children:
            yield from parts_of(child)


def holds_out(material):
    return material is not None and material.node_tree is not None and any(
        node.type == "HOLDOUT" for node in material.node_tree.nodes)


def holdout_of(layer):
    """What cuts holes into a view layer, in words; None where nothing does."""
    for part in parts_of(layer.layer_collection):
        if part.holdout and part.collection.all_objects:
            return "collection '%s' is a holdout" % part.name
    for thing in layer.objects:
        if thing.hide_render:
            continue
        if thing.is_holdout:
            return "object '%s' is a holdout" % thing.name
        if any(holds_out(slot.material) for slot in thing.material_slots):
            return "object '%s' has a holdout material" % thing.name
    return None


def denoises_in_vain(scene):
    """Cycles ends with an error where it lacks the denoiser it is to use."""
    if scene.render.engine != "CYCLES" or not scene.cycles.use_denoising:
        return False
    import _cycles
    return (scene.cycles.denoiser != "OPTIX"
            and not getattr(_cycles, "with_openimagedenoise", True))


def check_scene(scene):
    """Raises ValueError, which says what to change, where the scene cannot be
    rendered. Returns what is to be said of how it is."""
    layers = [layer for layer in scene.view_layers if layer.use]
    if not layers:
        raise ValueError("no view layer of scene '%s' is used for rendering: "
                         "switch one on in its properties" % scene.name)
    if scene.render.engine == "BLENDER_WORKBENCH":
        raise ValueError("Workbench renders neither light nor whole alpha: "
                         "choose Cycles or EEVEE as the render engine")
    if denoises_in_vain(scene):
        raise ValueError("denoising is on, but this Blender has no "
                         "OpenImageDenoise: switch it off under Sampling in "
                         "the render properties")
    warnings = []
    if scene.render.use_motion_blur:
        warnings.append("motion blur is on: objects blur, but the camera "
                        "stands still in each view")
    if scene.render.use_border:
        warnings.append("the render region is not used, because what is "
                        "outside it blurs into it: to get its pixels alone, "
                        "give dof-gather --region %d,%d,%d,%d"
                        % border_box(scene.render))
    found = next(filter(None, map(holdout_of, layers)), None)
    if found:
        warnings.append(found + ", whose edges come out wrong, because each "
                        "view looks past it elsewhere: render it and the rest "
                        "apart, without a holdout, and let dof-gather hold "
                        "one out by the other (docs/comp.md)")
    return warnings


# --- Rendering ---------------------------------------------------------------


@contextmanager
def changed(thing, **values):
    """Properties with other values for a while."""
    before = {name: getattr(thing, name) for name in values}
    try:
        for name, value in values.items():
            setattr(thing, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(thing, name, value)


@contextmanager
def still_camera(scene):
    """A camera without animation and without depth of field takes the place
    of the scene's for a while. Markers let go of their cameras meanwhile, or
    the render would switch to one of them."""
    data = bpy.data.cameras.new("sparselens view")
    made = bpy.data.objects.new("sparselens view", data)
    scene.collection.objects.link(made)
    try:
        with ExitStack() as stack:
            for marker in scene.timeline_markers:
                stack.enter_context(changed(marker, camera=None))
            stack.enter_context(changed(scene, camera=made))
            yield made
    finally:
        bpy.data.objects.remove(made)
        bpy.data.cameras.remove(data)


def file_settings(settings, multilayer, codec):
    """Values for `settings`, the image_settings of a render, that give an EXR
    with depth. Since Blender 4.0 only multilayer files have depth; Blender 5
    wants to know of several layers first, and parts of a file are its way of
    storing them unless told to interleave."""
    known = settings.bl_rna.properties
    single = not multilayer and "use_zbuffer" in known
    values = {
        "media_type": "IMAGE" if single else "MULTI_LAYER_IMAGE",
        "file_format": "OPEN_EXR" if single else "OPEN_EXR_MULTILAYER",
        "color_mode": "RGBA", "color_depth": "16", "exr_codec": codec,
        "use_exr_interleave": True, "use_zbuffer": True,
        "color_management": "FOLLOW_SCENE"}
    return {name: value for name, value in values.items() if name in known}


@contextmanager
def colour_and_depth(layer):
    """Switches off all other passes of a view layer for a while, but for its
    AOVs and light groups, which have no switch."""
    with ExitStack() as stack:
        for owner in (layer, layer.cycles, layer.eevee):
            names = [prop.identifier for prop in owner.bl_rna.properties
                     if prop.identifier.startswith("use_pass_")
                     or prop.identifier == "denoising_store_passes"]
            stack.enter_context(changed(owner, **{
                name: name in ("use_pass_combined", "use_pass_z")
                for name in names}))
        yield


@contextmanager
def render_settings(scene, size, multilayer=False, codec="ZIP"):
    """EXR with depth, of a picture of that size, and of nothing else than the
    views; afterwards all is as it was."""
    render = scene.render
    with ExitStack() as stack:
        stack.enter_context(changed(
            render.image_settings,
            **file_settings(render.image_settings, multilayer, codec)))
        stack.enter_context(changed(
            render, filepath="", use_multiview=False, use_compositing=False,
            use_sequencer=False, use_stamp=False, use_border=False,
            use_crop_to_border=False, border_min_x=0, border_max_x=1,
            border_min_y=0, border_max_y=1, resolution_percentage=100,
            resolution_x=size[0], resolution_y=size[1]))
        for layer in scene.view_layers:
            stack.enter_context(changed(layer, use_pass_z=True) if multilayer
                                else colour_and_depth(layer))
        yield


@contextmanager
def finer(scene, supersample):
    """As many fewer samples a pixel, for a while, as pixels are smaller."""
    subpixels = supersample * supersample
    cycles = scene.render.engine == "CYCLES"
    samples = (scene.cycles.samples if cycles
               else scene.eevee.taa_render_samples)
    if samples < subpixels:
        raise ValueError(
            "--supersample %d: %d samples a pixel are too few for %d pixels "
            "in its place" % (supersample, samples, subpixels))
    fewer = round(samples / subpixels)
    with (changed(scene.cycles, samples=fewer) if cycles
          else changed(scene.eevee, taa_render_samples=fewer)):
        yield


@contextmanager
def only_layer(scene, name):
    """Renders one view layer, for a while; with no name all that are used."""
    with ExitStack() as stack:
        for layer in scene.view_layers if name else ():
            stack.enter_context(changed(layer, use=layer.name == name))
        yield


def layer_to_render(scene, name, multilayer):
    """The name of the only view layer to render, or None for all. Says what
    of several will not be written."""
    names = [layer.name for layer in scene.view_layers]
    if name and name not in names:
        raise ValueError("--layer: the scene has no view layer '%s'; it has: "
                         "%s" % (name, ", ".join(names)))
    used = [layer.name for layer in scene.view_layers if layer.use]
    if not name and not multilayer and len(used) > 1:
        warn("the scene renders %d view layers, %s, of which the files hold "
             "'%s' alone: choose one by --layer, or take all by --multilayer"
             % (len(used), ", ".join(used), used[0]))
    return name or (None if multilayer else used[0])


def aim(camera, shot, placement, overscan):
    """Puts the made camera where a view is seen from. It sees `overscan`
    pixels more on each side; the sensor grows by as much."""
    camera.matrix_world = placement
    data, grown = camera.data, 1 + 2 * overscan / shot.size[0]
    data.lens, data.sensor_fit = shot.focal_length, "HORIZONTAL"
    data.sensor_width = shot.sensor_width * grown
    data.shift_x, data.shift_y = [shift / grown for shift in shot.shift]
    data.clip_start, data.clip_end = shot.clip


def set_border(render, box, overscan):
    """Renders only a box of pixels, x0, y0, x1, y1, y down, corners included.
    A quarter of a pixel keeps the edges from being rounded down."""
    render.use_border = box is not None
    if box is None:
        return
    x0, y0, x1, y1 = [side + overscan for side in box]
    width, height = render.resolution_x, render.resolution_y
    render.border_min_x = (x0 + 0.25) / width
    render.border_max_x = (x1 + 1.25) / width
    render.border_min_y = (height - y1 - 1 + 0.25) / height
    render.border_max_y = (height - y0 + 0.25) / height


def render_view(scene, path, shot, u, overscan, box=None, plain=True):
    """Renders what is seen from lens point u (x right, y up; the lens has the
    radius 1). The file appears complete or not at all; its channels have
    `plain` names where it holds colour and depth alone."""
    radius = shot.lens_radius
    placement = shot.placement @ Matrix.Translation(
        (radius * u[0], radius * u[1], 0))
    aim(scene.camera, shot, placement, overscan)
    set_border(scene.render, box, overscan)
    width, height = shot.size
    attributes = camera_attributes(shot, placement)
    attributes["displayWindow"] = exr_box(0, 0, width, height)
    attributes["dataWindow"] = exr_box(
        -overscan, -overscan, width + 2 * overscan, height + 2 * overscan)

    partial = path + ".partial.exr"
    scene.render.filepath = partial
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
        with open(partial, "rb") as file:
            data = with_attributes(file.read(), attributes, plain)
        with open(partial, "wb") as file:
            file.write(data)
        os.replace(partial, path)
    finally:
        if os.path.exists(partial):
            os.remove(partial)


AUTO = "auto"  # overscan: as much as the blur needs
LARGEST_PROBE = 512  # pixels
LARGEST_OVERSCAN = 1024  # pixels; as far as ldi-warp looks


def overscan_of(scene, folder, shot):
    """The pixels of overscan that the blur of a frame needs: its largest
    circle of confusion at the border. Read from the depth of a small picture
    of one sample a pixel."""
    shrink = min(1, LARGEST_PROBE / max(shot.size))
    size = [max(1, round(side * shrink)) for side in shot.size]
    path = os.path.join(folder, ".overscan.partial.exr")
    with ExitStack() as stack:
        stack.enter_context(render_settings(scene, size, codec="NONE"))
        stack.enter_context(changed(scene.cycles, samples=1))
        stack.enter_context(changed(scene.eevee, taa_render_samples=1))
        camera = stack.enter_context(still_camera(scene))
        stack.enter_context(changed(scene.render, filepath=path))
        aim(camera, shot, shot.placement, 0)
        try:
            bpy.ops.render.render(write_still=True, scene=scene.name)
            with open(path, "rb") as file:
                rows = depth_rows(file.read())
        finally:
            if os.path.exists(path):
                os.remove(path)

    def largest(depths, stretch, most):
        radius = max(shot.blur_radius(depth) for depth in depths if depth > 0)
        return min(math.ceil(radius * stretch), most, LARGEST_OVERSCAN)

    columns = [row[0] for row in rows] + [row[-1] for row in rows]
    return max(largest(columns, 1, shot.size[0]),
               largest(rows[0] + rows[-1], shot.pixel_aspect, shot.size[1]))


def rim_points(count):
    angles = [2 * math.pi * k / count for k in range(count)]
    return [(math.cos(angle), math.sin(angle)) for angle in angles]


def spiral_points(count):
    """Points spread evenly over the lens, as sunflowers have their seeds."""
    golden = math.pi * (3 - math.sqrt(5))
    polar = [(math.sqrt((k + 0.5) / count), k * golden) for k in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle))
            for radius, angle in polar]


def plain_name(name):
    """A plan's name for a view; it becomes a file's in the output folder,
    and must not lead out of it."""
    if not isinstance(name, str) or not re.fullmatch(r"\w[\w.-]{0,99}", name):
        raise ValueError("--plan: the view %r has no plain name, such as "
                         "view_0" % (name,))
    return name


def check_plan(plan, size, supersample):
    """Refuses a plan of a picture of another size, or of other sub-pixels:
    its boxes are not where they should be."""
    window = plan.get("display_window")
    if window != [0, 0, size[0] - 1, size[1] - 1]:
        raise ValueError(
            "--plan: it was made for a picture with the window %s, and this "
            "one has %dx%d pixels: give the resolution and --supersample of "
            "its centre view" % (window, size[0], size[1]))
    of_plan = plan.get("center_supersample", supersample)
    if of_plan != supersample:
        raise ValueError("--plan: its centre view was rendered with "
                         "--supersample %s: give it here, too" % (of_plan,))


def views_of_plan(plan):
    """Names, lens points and boxes of what a plan of ldi-plan asks for; it
    was made from the centre view, which is there already."""
    return [("%s_%d" % (plain_name(view["name"]), number),
             view["lens_point"], box)
            for view in plan["views"]
            for number, box in enumerate(view["rectangles"])]


def views_of_lens(rim, spread):
    """The centre, `rim` views from the rim and `spread` all over the lens."""
    return ([("center", (0, 0), None)]
            + [("view_%d" % k, u, None)
               for k, u in enumerate(rim_points(rim))]
            + [("lens_%04d" % k, u, None)
               for k, u in enumerate(spiral_points(spread))])


def numbered(name, frame):
    """The name with the frame's number for each run of #."""
    return re.sub("#+", lambda run: "%0*d" % (
        4 if len(run[0]) == 1 else len(run[0]), frame), name)


def warn(text):
    print("sparselens_views.py: warning:", text, file=sys.stderr)


def render_frame(scene, folder, ending, views, eyes, overscan=0,
                 multilayer=False, layer=None, supersample=1):
    """Renders the views of the current frame into the folder. `overscan` is
    in pixels of the scene's picture, or AUTO; `layer` the only view layer to
    render; `supersample` how many pixels, across and down, are rendered for
    one of the picture."""
    shots = [(eye, shot_of(scene, eye, supersample)) for eye in eyes]
    for eye, shot in shots:
        pixels = overscan
        if overscan == AUTO:
            with only_layer(scene, layer):
                pixels = math.ceil(overscan_of(scene, folder, shot)
                                   / supersample)
            print("sparselens_views.py: frame %d%s: overscan of %d pixels" % (
                scene.frame_current, eye.name and ", " + eye.name, pixels))
        beyond = pixels * supersample
        size = [side + 2 * beyond for side in shot.size]
        with render_settings(scene, size, multilayer), still_camera(scene), \
                only_layer(scene, layer), finer(scene, supersample):
            for name, u, box in views:
                path = os.path.join(folder, name + eye.file_suffix + ending)
                render_view(scene, path, shot, u, beyond, box,
                            plain=not multilayer)


def render_frames(scene, frames, folder, views_at, eyes, several=False,
                  say=warn, **options):
    """The same for a list of frames; views_at(frame) are the views of one.
    With `several` the names carry the frame's number. Warnings go to `say`,
    once for all frames."""
    for text in check_scene(scene):
        say(text)
    folder, before = os.path.abspath(folder), scene.frame_current
    options["layer"] = layer_to_render(scene, options.get("layer"),
                                       options.get("multilayer"))
    os.makedirs(folder, exist_ok=True)
    try:
        for frame in frames:
            scene.frame_set(frame)
            ending = ".%04d.exr" % frame if several else ".exr"
            render_frame(scene, folder, ending, views_at(frame), eyes,
                         **options)
    finally:
        scene.frame_set(before)


# --- Add-on ------------------------------------------------------------------


class SPARSELENS_Settings(bpy.types.PropertyGroup):
    folder: bpy.props.StringProperty(
        name="Folder", description="Where the views go", subtype="DIR_PATH",
        default="//views/")
    views: bpy.props.IntProperty(
        name="Rim Views", description="Views from the rim of the lens",
        default=4, min=0, max=64)
    overscan: bpy.props.IntProperty(
        name="Overscan", description="Pixels rendered beyond each side",
        default=0, min=0, max=4096, subtype="PIXEL")
    overscan_auto: bpy.props.BoolProperty(
        name="Automatic Overscan",
        description="As many pixels beyond each side as the blur at the "
                    "border needs, at each frame, instead of Overscan")
    supersample: bpy.props.IntProperty(
        name="Supersample", description="Pixels rendered, across and down, "
        "for each of the picture, with as many fewer samples",
        default=1, min=1, max=16)
    multilayer: bpy.props.BoolProperty(
        name="All Passes",
        description="Multilayer EXR with all passes of the view layers")
    animation: bpy.props.BoolProperty(
        name="Animation",
        description="All frames of the scene, else the current one")


class SPARSELENS_OT_render_views(bpy.types.Operator):
    """Render the centre view and the views from the rim of the lens"""

    bl_idname = "sparselens.render_views"
    bl_label = "Render Views"

    def execute(self, context):
        scene, settings = context.scene, context.scene.sparselens
        frames = [scene.frame_current]
        if settings.animation:
            frames = range(scene.frame_start, scene.frame_end + 1,
                           scene.frame_step)
        try:
            views = views_of_lens(settings.views, 0)
            render_frames(scene, frames, bpy.path.abspath(settings.folder),
                          lambda frame: views, eyes_of(scene),
                          several=settings.animation,
                          say=lambda text: self.report({"WARNING"}, text),
                          overscan=(AUTO if settings.overscan_auto
                                    else settings.overscan),
                          multilayer=settings.multilayer,
                          supersample=settings.supersample)
        except (ValueError, OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class SPARSELENS_PT_panel(bpy.types.Panel):
    bl_label = "sparselens"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.camera is not None

    def draw(self, context):
        self.layout.use_property_split = True
        for name in SPARSELENS_Settings.__annotations__:
            self.layout.prop(context.scene.sparselens, name)
        self.layout.operator("sparselens.render_views")


CLASSES = (SPARSELENS_Settings, SPARSELENS_OT_render_views,
           SPARSELENS_PT_panel)


def register():
    for made in CLASSES:
        bpy.utils.register_class(made)
    bpy.types.Scene.sparselens = bpy.props.PointerProperty(
        type=SPARSELENS_Settings)


def unregister():
    del bpy.types.Scene.sparselens
    for made in reversed(CLASSES):
        bpy.utils.unregister_class(made)


# --- Script ------------------------------------------------------------------


def frame_numbers(text):
    """The frames of "1-24", "1-100x2" or "3,5-7", in that order."""
    numbers = []
    for part in text.split(","):
        match = re.fullmatch(r"(-?\d+)(?:-(-?\d+)(?:x([1-9]\d*))?)?", part)
        if not match:
            raise argparse.ArgumentTypeError(
                "invalid frame range '%s' (expected e.g. 1-100x2)" % text)
        first = int(match[1])
        last = first if match[2] is None else int(match[2])
        step = int(match[3] or 1)
        numbers += (range(first, last + 1, step) if first <= last
                    else range(first, last - 1, -step))
    return numbers


def natural_number(text):
    if not re.fullmatch(r"\d{1,6}", text):
        raise argparse.ArgumentTypeError("'%s' is not a number from 0" % text)
    return int(text)


def overscan_option(text):
    return AUTO if text == AUTO else natural_number(text)


def read_options(arguments):
    parser = argparse.ArgumentParser(
        prog="sparselens_views.py",
        usage="blender -b SCENE.blend -P sparselens_views.py -- -o DIR "
              "[options]",
        description="Renders the centre view and the views from the rim of "
                    "the lens, from the scene's camera.")
    add = parser.add_argument
    add("-o", "--output", required=True, metavar="DIR",
        help="folder of the views: center.exr, view_0.exr, ...")
    add("--views", type=natural_number, default=4, metavar="N",
        help="views from the rim of the lens (default: 4)")
    frames = parser.add_mutually_exclusive_group()
    frames.add_argument(
        "--frame", type=int, metavar="N",
        help="frame to render (default: the scene's current one)")
    frames.add_argument(
        "--frames", type=frame_numbers, metavar="RANGE",
        help="frames to render, e.g. 1-24; the files are center.####.exr, "
             "view_0.####.exr, ...")
    add("--samples", type=natural_number, metavar="N",
        help="samples a pixel of the picture (default: the scene's)")
    add("--supersample", type=natural_number, default=1, metavar="N",
        help="render N times the width and height with 1/N^2 of the samples "
             "a pixel; dof-gather makes the picture of the scene's size of "
             "it (default: 1)")
    add("--overscan", type=overscan_option, default=0, metavar="PX",
        help="pixels of the picture to render beyond each side (default: 0); "
             "auto: as many as the blur at the border of each frame needs")
    add("--multilayer", action="store_true",
        help="multilayer EXR with all passes of the view layers, AOVs and "
             "Cryptomatte too (default: colour and depth)")
    add("--layer", metavar="NAME",
        help="the only view layer to render (default: all that are switched "
             "on; without --multilayer there may be only one)")
    add("--eye", metavar="NAME",
        help="view of a stereo scene, e.g. left (default: all of them, the "
             "eye's suffix in the names of the files)")
    add("--plan", metavar="PLAN.json",
        help="render only what this file of ldi-plan asks for, a file a "
             "rectangle: view_0_0.exr, ...; plan.####.json for --frames")
    add("--lens-views", type=natural_number, default=0, metavar="N",
        help="also render N views spread over the lens, lens_0000.exr, ..., "
             "whose average (dof-accumulate) is the true picture")
    options = parser.parse_args(arguments)
    if options.samples == 0:
        parser.error("argument --samples: 0 samples make no picture")
    if not 1 <= options.supersample <= 16:
        parser.error("argument --supersample: must be from 1 to 16")
    if options.supersample > 1 and options.lens_views:
        parser.error("argument --lens-views: their average is the picture: "
                     "render them without --supersample")
    return options


def chosen_eyes(scene, name):
    eyes = eyes_of(scene)
    if name is None:
        return eyes
    chosen = [eye for eye in eyes if eye.name == name]
    if not chosen:
        raise ValueError("--eye: the scene has no eye '%s'; it has: %s" % (
            name, ", ".join(eye.name or "one without a name" for eye in eyes)))
    return chosen


def main(arguments):
    options = read_options(arguments)
    scene = bpy.context.scene
    eyes = chosen_eyes(scene, options.eye)
    if options.plan and len(eyes) > 1:
        raise ValueError("--plan: a plan is made for one eye: name it (--eye)")
    if options.samples:
        scene.cycles.samples = options.samples
        scene.eevee.taa_render_samples = options.samples

    def views_at(frame):
        if not options.plan:
            return views_of_lens(options.views, options.lens_views)
        with open(numbered(options.plan, frame)) as file:
            plan = json.load(file)
        check_plan(plan, shot_of(scene, eyes[0], options.supersample).size,
                   options.supersample)
        return views_of_plan(plan)

    frames = options.frames
    if frames is None:
        frames = [scene.frame_current if options.frame is None
                  else options.frame]
    render_frames(scene, frames, options.output, views_at, eyes,
                  several=options.frames is not None,
                  overscan=options.overscan, multilayer=options.multilayer,
                  layer=options.layer, supersample=options.supersample)


def run_as_script():
    """Blender goes on after an exception, and ends with 0: end it here."""
    after = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    try:
        main(sys.argv[after:])
    except (ValueError, OSError, RuntimeError) as error:
        print("sparselens_views.py: error:", error, file=sys.stderr)
        sys.exit(1)
    except Exception:
        traceback.print_exc()
        sys.exit(1)


if __name__ == "__main__":
    if bpy.app.background or "--" in sys.argv:
        run_as_script()
    else:
        register()  # from Blender's text editor
