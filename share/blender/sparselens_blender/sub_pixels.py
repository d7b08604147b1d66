"""Whether a frame's views are worth twice the size of its picture, as ldi-plan
advises: where many pixels are at edges of depth."""

import os
from operator import or_

from .temporary_settings import samples_of
from .kept import header_of, is_of_camera, supersample_of
from .one_view import border_blur, probe_steps
from .shots import shot_of

AUTO = "auto"  # supersample and overscan: as the frame needs it
MANY_EDGES = 0.05  # share of the pixels; many_edges of src/plan/tuning.h
TORN = 1  # pixels of disparity; torn_px of src/kernels/surface.h


def supersample_in(settings):
    """What the panel says: a number, or AUTO."""
    return AUTO if settings.supersample_auto else settings.supersample


def share_at_edges(rows, shot):
    """The share of the pixels beside a jump of depth, as share_at_edges() of
    src/plan/disocclusion.h has it."""
    scale = shot.lens_radius * shot.focal_pixels
    count, above, marked_above = 0, None, []
    for row in rows:
        depths = [scale / z if z > 0 else 0 for z in row]  # disparity
        jumps = [abs(a - b) > TORN for a, b in zip(depths, depths[1:])]
        marked = list(map(or_, [False] + jumps, jumps + [False]))
        if above:
            jumps = [abs(a - b) > TORN for a, b in zip(above, depths)]
            count += sum(map(or_, marked_above, jumps))
            marked = list(map(or_, marked, jumps))
        above, marked_above = depths, marked
    return (count + sum(marked_above)) / (len(rows) * len(rows[0]))


def kept_supersample(scene, eye, center, moments):
    """The supersample of a centre view of an earlier run that may stay."""
    header = header_of(center)
    if header is None:
        return None
    number = supersample_of(header)
    fits = (samples_of(scene) >= number * number * moments
            and is_of_camera(header, shot_of(scene, eye, number), wider=True))
    return number if fits else None


def supersample_steps(scene, center, eye, keep, layers, moments):
    """The supersample of the views of this frame, 1 or 2; with `keep`, the one
    of an earlier run's centre view. Each of the frame's moments has its part
    of the samples. It is found from a picture of one sample per pixel, of the
    view layer with the most edges. The first eye of a scene decides for all,
    so that they are alike. Also returns the overscan that the same picture
    asks for, or None if none was rendered."""
    if samples_of(scene) < 4 * moments:
        return 1, None
    kept = keep and kept_supersample(scene, eye, center, moments)
    if kept:
        return kept, None
    shot, share, beyond = shot_of(scene, eye), 0, 0
    for layer in layers:
        rows = yield from probe_steps(
            scene, os.path.join(os.path.dirname(center), ".edges.%04d.partial"
                                ".exr" % scene.frame_current),
            shot, shot.size, layer, "edges")
        share = max(share, share_at_edges(rows, shot))
        beyond = max(beyond, border_blur(rows, shot))
    number = 2 if share >= MANY_EDGES else 1
    print("sparselens: frame %g: %.1f %% of the pixels are at edges of depth: "
          "supersample %d" % (scene.frame_current + scene.frame_subframe,
                              100 * share, number))
    return number, beyond
