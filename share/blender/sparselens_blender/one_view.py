"""Renders one view, and finds how much overscan a frame needs. The steps are
generators, as in renders.py.
"""

import math
import os
from contextlib import ExitStack

from .exr import depth_rows, with_attributes
from .temporary_settings import changed, only_layer, render_settings, still_camera
from .shots import camera_attributes, view_placement

LARGEST_PROBE = 512  # pixels
LARGEST_OVERSCAN = 1024  # pixels; ldi-warp looks no farther


def aim(camera, shot, placement, overscan):
    """Puts the made camera at the position of a view. It sees `overscan`
    pixels more on each side, and its sensor grows accordingly."""
    camera.matrix_world = placement
    data, grown = camera.data, 1 + 2 * overscan / shot.size[0]
    data.lens, data.sensor_fit = shot.focal_length, "HORIZONTAL"
    data.sensor_width = shot.sensor_width * grown
    data.shift_x, data.shift_y = [shift / grown for shift in shot.shift]
    data.clip_start, data.clip_end = shot.clip


def set_border(render, box, overscan):
    """Renders only a box of pixels, x0, y0, x1, y1, y down, corners included.
    A margin of a quarter of a pixel keeps the edges from being rounded
    down."""
    render.use_border = box is not None
    if box is None:
        return
    x0, y0, x1, y1 = [side + overscan for side in box]
    width, height = render.resolution_x, render.resolution_y
    render.border_min_x = (x0 + 0.25) / width
    render.border_max_x = (x1 + 1.25) / width
    render.border_min_y = (height - y1 - 1 + 0.25) / height
    render.border_max_y = (height - y0 + 0.25) / height


def write_whole(partial, path, data):
    """Writes a file under another name first, so that it is never there in
    part."""
    try:
        with open(partial, "wb") as file:
            file.write(data)
        os.replace(partial, path)
    except OSError as error:  # by write(), it does not name the file
        raise OSError("%s: %s" % (path, error.strerror)) from error


def view_steps(scene, path, shot, u, overscan, box, attributes, plain):
    """Renders the view from lens point u. The file appears complete or not at
    all; with `plain`, its channels get plain names if it holds only colour and
    depth."""
    placement = view_placement(shot, u)
    aim(scene.camera, shot, placement, overscan)
    set_border(scene.render, box, overscan)
    partial = path + ".partial.exr"
    scene.render.filepath = partial
    try:
        yield os.path.basename(path)
        with open(partial, "rb") as file:
            data = with_attributes(
                file.read(), camera_attributes(shot, placement) | attributes,
                plain)
        write_whole(partial, path, data)
    finally:
        if os.path.exists(partial):
            os.remove(partial)


def probe_steps(scene, path, shot, size, layer, words):
    """Renders a picture of one sample per pixel, of this size, from the centre
    of the lens, for its depth alone, and returns the rows of depth."""
    with ExitStack() as stack:
        stack.enter_context(only_layer(scene, layer))
        stack.enter_context(render_settings(scene, size, codec="NONE"))
        stack.enter_context(changed(scene.cycles, samples=1, max_bounces=0,
                                    use_denoising=False))
        stack.enter_context(changed(scene.eevee, taa_render_samples=1))
        camera = stack.enter_context(still_camera(scene))
        stack.enter_context(changed(scene.render, filepath=path))
        aim(camera, shot, shot.placement, 0)
        try:
            yield words
            with open(path, "rb") as file:
                return depth_rows(file.read())
        finally:
            if os.path.exists(path):
                os.remove(path)


def border_blur(rows, shot):
    """The largest circle of confusion at the border of a picture with these
    rows of depth, in pixels of the shot; at most the picture's size."""
    def largest(depths, stretch, most):
        radius = max(shot.blur_radius(depth) for depth in depths if depth > 0)
        return min(math.ceil(radius * stretch), most, LARGEST_OVERSCAN)

    columns = [row[0] for row in rows] + [row[-1] for row in rows]
    return max(largest(columns, 1, shot.size[0]), largest(
        rows[0] + rows[-1], shot.pixel_aspect, shot.size[1]))


def overscan_steps(scene, folder, shot, layers):
    """The pixels of overscan that the blur of a frame needs: the largest
    circle of confusion at its border, in any of the layers. It is read from
    small pictures."""
    shrink = min(1, LARGEST_PROBE / max(shot.size))
    size = [max(1, round(side * shrink)) for side in shot.size]
    path = os.path.join(folder, ".overscan.%04d.partial.exr"
                        % scene.frame_current)
    found = 0
    for layer in layers:
        found = max(found, border_blur((yield from probe_steps(
            scene, path, shot, size, layer, "overscan")), shot))
    return found
