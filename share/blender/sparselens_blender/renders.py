"""Renders the views of frames into a folder."""

import math
import os
import sys
from contextlib import ExitStack

import bpy
from mathutils import Matrix

from .checks import check_scene
from .exr import depth_rows, exr_box, with_attributes
from .for_a_while import (
    changed, finer, only_layer, render_settings, still_camera)
from .shots import camera_attributes, shot_of

AUTO = "auto"  # overscan: as much as the blur needs
LARGEST_PROBE = 512  # pixels
LARGEST_OVERSCAN = 1024  # pixels; as far as ldi-warp looks


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
