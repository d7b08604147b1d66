"""The camera at a frame, after animation, drivers and constraints, and the EXR
attributes that describe it.
"""

import math
import os
from dataclasses import dataclass

import bpy
from mathutils import Matrix

from .exr import exr_float, exr_int, exr_matrix, exr_point, exr_text


@dataclass
class Shot:
    """The scene's camera at one frame, for one eye, after animation, drivers
    and constraints. In Blender's units, which Cycles treats as metres."""

    scene: str             # its name
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
    pixel_filter: str      # of the picture, as in ldi.pixelFilter

    @property
    def lens_radius(self):
        return self.focal_length / 1000 / (2 * self.fstop)

    @property
    def focal_pixels(self):
        return self.focal_length * self.size[0] / self.sensor_width

    def blur_radius(self, depth):
        """The radius of the circle of confusion at this depth, in pixels,
        horizontally."""
        return (self.lens_radius * self.focal_pixels / self.focus_distance
                * abs(depth - self.focus_distance) / depth)


@dataclass
class Eye:
    """A view of a stereo scene, or the only one."""

    name: str = ""
    file_suffix: str = ""
    camera_suffix: str = ""
    side: int = 0  # of a stereo pair made of one camera: -1 left, 1 right


def eyes_of(scene):
    """The eyes that the scene's Stereoscopy panel sets."""
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
    """The camera object of an eye. The cameras of a multi-view scene have
    different name endings."""
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
    """The position and rotation of an eye of a stereo pair in its camera's
    space."""
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
    """The lens shift of an eye of an off-axis stereo pair, in addition to the
    camera's. In Blender's unit of lens shift, which is a sensor width here for
    every sensor fit."""
    stereo = data.stereo
    if side == 0 or stereo.convergence_mode != "OFFAXIS":
        return 0
    moved = stereo_offset(stereo, side).translation.x
    return -moved / data.sensor_width * data.lens / stereo.convergence_distance


def focus_distance_of(data, placement, depsgraph):
    """Depth of the plane of focus; of the focus object or its bone, if set."""
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
    rounded as Blender does."""
    width, height = picture_size(render)
    left, right = [int(x * width) for x in (render.border_min_x,
                                            render.border_max_x)]
    bottom, top = [int(y * height) for y in (render.border_min_y,
                                             render.border_max_y)]
    return left, height - top, right - 1, height - bottom - 1


def pixel_filter_of(scene):
    """The engine's pixel filter and its width, as in ldi.pixelFilter. EEVEE's
    is the default filter of Cycles."""
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
        scene=scene.name, camera=camera.name, placement=placement,
        size=(width * supersample, height * supersample),
        pixel_aspect=render.pixel_aspect_x / render.pixel_aspect_y,
        focal_length=data.lens, sensor_width=sensor * width / fitted,
        shift=(shift[0] * fitted / width, shift[1] * fitted / width),
        clip=(data.clip_start, data.clip_end), fstop=data.dof.aperture_fstop,
        focus_distance=focus_distance,
        blades=data.dof.aperture_blades, rotation=data.dof.aperture_rotation,
        ratio=data.dof.aperture_ratio, supersample=supersample,
        pixel_filter=pixel_filter_of(scene))


def view_placement(shot, u):
    """The camera-to-world matrix for lens point u (x right, y up; the rim is
    at radius 1)."""
    radius = shot.lens_radius
    return shot.placement @ Matrix.Translation(
        (radius * u[0], radius * u[1], 0))


def camera_attributes(shot, placement):
    """The EXR attributes of a view. Camera space in EXR: x right, y up, z
    forward. Blender's z points backward."""
    field = shot.sensor_width / shot.focal_length
    to_camera = Matrix.Diagonal((1, 1, -1, 1)) @ placement.inverted()
    subpixels = {} if shot.supersample == 1 else {
        "ldi.supersample": exr_int(shot.supersample),
        "ldi.pixelFilter": exr_text(shot.pixel_filter),
    }
    return subpixels | {
        "sparselens:scene": exr_text(shot.scene),
        "sparselens:file": exr_text(os.path.basename(bpy.data.filepath)),
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
