"""Volumes as one deep view, for Cycles, which writes no deep pictures.

The views are rendered without volumes before the camera; volumes still light
and shadow everything. The volumes themselves are rendered from the centre of
the lens in slices of depth: the camera clips what is nearer, and a plane that
only the camera sees ends the slice. All other objects are holdouts. The slices
become samples of one deep EXR with Z and ZBack, which ldi-cluster merges with
the LDI of the views.
"""

import math
import os
from contextlib import ExitStack, contextmanager

import bpy
import numpy
from mathutils import Matrix

from .deep_exr import read_planes, write_deep
from .exr import exr_text
from .temporary_settings import changed, render_settings, still_camera
from .one_view import aim
from .shots import view_placement
from .volumes import only_volumes, volume_depths

THINNEST = 1 / 8  # of a slice: a sample that is continued behind a solid
MOST_BLUR = 1 / 24  # of the picture's width, in px of CoC
SKY = 1e9         # depths beyond are the sky
OF_ALL_FILES = ("pixelAspectRatio", "screenWindowCenter", "screenWindowWidth",
                "chromaticities", "colorInteropID")


@contextmanager
def end_plane(scene):
    """A plane that is a holdout and seen by the camera alone."""
    material = bpy.data.materials.new("sparselens end")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    material.node_tree.links.new(
        nodes.new("ShaderNodeHoldout").outputs[0],
        nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    mesh = bpy.data.meshes.new("sparselens end")
    mesh.from_pydata([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)], [],
                     [(0, 1, 2, 3)])
    mesh.materials.append(material)
    plane = bpy.data.objects.new("sparselens end", mesh)
    for ray in "diffuse", "glossy", "transmission", "volume_scatter", "shadow":
        setattr(plane, "visible_" + ray, False)
    scene.collection.objects.link(plane)
    try:
        yield plane
    finally:
        bpy.data.objects.remove(plane)
        bpy.data.meshes.remove(mesh)
        bpy.data.materials.remove(material)


def not_too_near(near, far, shot):
    """Where a range shall begin. Fog around the camera does not begin before
    the lens, where it would cost the gather much time for discs that hide
    nothing, but where its circles of confusion are MOST_BLUR; the first slice
    also has what is nearer."""
    most = MOST_BLUR * shot.size[0]
    scale = shot.blur_radius(shot.focus_distance / 2)  # that of 1 / distance
    begin = shot.focus_distance / (1 + most / scale)
    return begin if near < begin < far else near


def sliced(ranges, count, shot):
    """Slices (near, far) of these ranges, at least one of each. What a slice
    blurs wrongly grows with its coverage, taken as that of an even volume, and
    with the change of its circle of confusion c, counted in px near the focus
    and relatively far from it, as asinh(c). Slices are spread so that the sum
    of coverage times the square of this change is the least: their density is
    (d asinh(c) / dz)^(2/3)."""
    steps = 1024

    def scale(depth):
        return math.asinh(math.copysign(shot.blur_radius(depth),
                                        depth - shot.focus_distance))

    shares = []
    for near, far in ranges:
        near = not_too_near(near, far, shot)
        depths = [near * (far / near) ** (k / steps) for k in range(steps + 1)]
        sums = [0]
        for a, b in zip(depths, depths[1:]):
            sums.append(sums[-1] + abs(scale(b) - scale(a)) ** (2 / 3)
                        * (b - a) ** (1 / 3))
        shares.append((depths, sums))
    whole = sum(sums[-1] for _, sums in shares)
    slices = []
    for depths, sums in shares:
        number = max(1, round(count * sums[-1] / whole))
        cuts = numpy.interp([sums[-1] * k / number for k in range(number + 1)],
                            sums, depths)
        slices += zip(map(float, cuts[:-1]), map(float, cuts[1:]))
    return slices


def continued(colours, coverage, depth, near, far):
    """A slice before a solid at this depth, within the slice, as a volume that
    goes on behind it with the same density. The sample then has one extent
    everywhere, and is split at the solid when it is merged with it."""
    inside = (depth > near) & (depth < far)
    long = (far - near) / numpy.where(inside, depth - near, far - near)
    before = numpy.clip(coverage, 0, 0.9999)
    behind = 1 - (1 - before) ** numpy.minimum(long, 1 / THINNEST)
    grown = numpy.where(before > 1e-6, behind / numpy.maximum(before, 1e-6),
                        numpy.minimum(long, 1 / THINNEST))
    return [colour * grown for colour in colours] + [behind]


def put_clips(camera, plane, shot, grown, near, far):
    camera.data.clip_start, camera.data.clip_end = near, 4 * far
    field = shot.sensor_width / shot.focal_length
    height = shot.size[1] / (shot.size[0] * shot.pixel_aspect)
    wide = far * field * max(1, height) * (
        grown + 2 * max(map(abs, shot.shift)))
    plane.matrix_world = camera.matrix_world @ Matrix.Diagonal(
        (wide, wide, far, 1))


def slice_steps(scene, path, center, shot, overscan, manner, unseen,
                attributes):
    """Renders the slices, and writes them as the deep EXR `path`. `center`:
    the centre view without volumes, whose depth says where solids are.
    `unseen`: objects that are in other layers."""
    layer = scene.view_layers[manner.layer] if manner.layer else next(
        layer for layer in scene.view_layers if layer.use)
    grown = 1 + 2 * overscan / shot.size[0]
    ranges = volume_depths(scene, layer, shot, grown)
    header, (depth,) = read_planes(center, ["Z"])
    if depth.max() < SKY:  # nothing is seen behind the farthest solid
        ranges = [(near, min(far, float(depth.max()) * 1.001))
                  for near, far in ranges if near < depth.max()]
    slices = sliced(ranges, manner.slices, shot) if ranges else []
    size = [side + 2 * overscan for side in shot.size]
    partial = path + ".slice.partial.exr"
    found = []
    with ExitStack() as stack:
        stack.enter_context(render_settings(scene, size, codec="NONE"))
        camera = stack.enter_context(still_camera(scene))
        stack.enter_context(only_volumes(scene, unseen))
        plane = stack.enter_context(end_plane(scene))
        aim(camera, shot, view_placement(shot, (0, 0)), overscan)
        stack.enter_context(changed(scene.render, filepath=partial))
        begins = {not_too_near(*ends, shot): ends[0] for ends in ranges}
        for number, (near, far) in enumerate(slices):
            put_clips(camera, plane, shot, grown, begins.get(near, near), far)
            try:
                yield "slice %d of %d" % (number + 1, len(slices))
                _, (*colours, coverage) = read_planes(partial, "RGBA")
            finally:
                if os.path.exists(partial):
                    os.remove(partial)
            found.append(numpy.array(continued(
                colours, coverage, depth, near, far), numpy.float16))
    of_slices = numpy.array(found, numpy.float16).reshape(-1, 4, *depth.shape)
    planes = {name: of_slices[:, at] for at, name in enumerate("RGBA")}
    for name, ends in zip(("Z", "ZBack"), numpy.array(
            slices, numpy.float32).reshape(-1, 2).T):
        planes[name] = numpy.broadcast_to(ends[:, None, None],
                                          planes["A"].shape)
    write_deep(path, {name: header[name] for name in OF_ALL_FILES
                      if name in header} | attributes | {
        "sparselens:sliceDepths": exr_text(" ".join(
            "%g,%g" % ends for ends in slices))}, planes)
