"""The moments of a shutter: sub-frames of the scene, each rendered for itself
with its part of the samples. dof-gather makes one picture of them.
"""

import math
import os
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from .exr import exr_float, exr_int
from .temporary_settings import changed
from .shots import shot_of

MOST = 64
LEAST_ROLLING = 0.001  # of --rolling-shutter of dof-gather
SEEDS_APART = 9973  # between moments; halves.py takes the seeds beside them


@dataclass
class Moment:
    """A moment of the shutter of a frame."""

    frame: int
    number: int  # from 0
    count: int   # of the shutter's moments
    time: float  # in frames

    @property
    def attributes(self):
        return {"sparselens:frame": exr_int(self.frame),
                "sparselens:moment": exr_int(self.number),
                "sparselens:moments": exr_int(self.count),
                "sparselens:time": exr_float(self.time)}


def of_moment(path, number="%s"):
    """The name of a moment's file; with %s, that of all moments' files, as
    the tools read it."""
    stem, ending = os.path.splitext(path)
    return "%s_%s%s" % (stem, number, ending)


def times_of(values, count):
    """`count` times from 0 to 1 that each stand for an equal part of a
    curve's area. The values are the curve's, at equal distances."""
    sums = [0]
    for one, other in zip(values, values[1:]):
        sums.append(sums[-1] + one + other)
    times, piece = [], 0
    for number in range(count):
        area = sums[-1] * (number + 0.5) / count
        while sums[piece + 1] < area:
            piece += 1
        part = (area - sums[piece]) / (sums[piece + 1] - sums[piece])
        times.append((piece + part) / (len(values) - 1))
    return times


def settings_of(scene):
    """Where the engine keeps its settings of motion blur, most of which
    Blender 4 has moved to one place."""
    engine = scene.cycles if scene.render.engine == "CYCLES" else scene.eevee
    return [engine, scene.render]


def setting(scene, name):
    return next(getattr(owner, name) for owner in settings_of(scene)
                if hasattr(owner, name))


def curve_of(scene):
    mapping, pieces = scene.render.motion_blur_shutter_curve, 256
    mapping.initialize()
    values = [max(0.0, mapping.evaluate(mapping.curves[0], piece / pieces))
              for piece in range(pieces + 1)]
    if max(values) == 0:
        raise ValueError("the shutter's curve is 0: set another one under "
                         "Motion Blur in the render properties")
    return values


def rolling_duration(scene):
    """The part of the shutter's time for which each row is exposed: 1 without
    a rolling shutter, which Cycles alone has."""
    if scene.render.engine != "CYCLES" or \
            scene.cycles.rolling_shutter_type == "NONE":
        return 1
    return max(LEAST_ROLLING, scene.cycles.rolling_shutter_duration)


def shutter_options(scene, count, folder):
    """Options that tell dof-gather about a rolling shutter. Each row has its
    own exposure, with the whole curve, which goes into a file in the
    folder."""
    duration = rolling_duration(scene)
    if count <= 1 or duration == 1:
        return []
    options, values = ["--rolling-shutter", repr(duration)], curve_of(scene)
    if min(values) < max(values):
        os.makedirs(folder, exist_ok=True)
        curve = os.path.join(folder, "shutter_curve.txt")
        with open(curve, "w") as file:
            for piece, value in enumerate(values):
                file.write("%r %r\n" % (piece / (len(values) - 1), value))
        options += ["--shutter-curve", curve]
    return options


def moments_of(scene, frame, count):
    """The moments of a frame's shutter; None in their place, once, for a
    still. Each stands for an equal part of the light, or, if the shutter
    rolls, of the time."""
    if count <= 1:
        return [None]
    length = setting(scene, "motion_blur_shutter")
    begin = frame + length * {"START": 0, "CENTER": -0.5, "END": -1}[
        setting(scene, "motion_blur_position")]
    values = curve_of(scene) if rolling_duration(scene) == 1 else [1, 1]
    return [Moment(frame, number, count, begin + length * time)
            for number, time in enumerate(times_of(values, count))]


@contextmanager
def at_moment(scene, moment):
    """Sets the scene to the moment for a while, without motion blur and with
    noise of its own."""
    if moment is None:
        yield
        return
    before = scene.frame_current, scene.frame_subframe
    frame = math.floor(moment.time)
    seed = (scene.cycles.seed + moment.number * SEEDS_APART) % 2 ** 31
    scene.frame_set(frame, subframe=moment.time - frame)
    try:
        with ExitStack() as stack:
            for owner in settings_of(scene):
                if hasattr(owner, "use_motion_blur"):
                    stack.enter_context(changed(owner, use_motion_blur=False))
            stack.enter_context(changed(scene.cycles, seed=seed))
            yield
    finally:
        scene.frame_set(before[0], subframe=before[1])


def shot_of_first(scene, eye, supersample, count):
    """The camera at the first moment of the current frame."""
    first = moments_of(scene, scene.frame_current, count)[0]
    with at_moment(scene, first):
        return shot_of(scene, eye, supersample)


def forget_more(first, count):
    """Deletes the files of moments that an earlier run with more of them has
    left, because the tools would count them too. `first`: the file of moment
    0."""
    stem, ending = os.path.splitext(first)
    for number in range(count, MOST):
        path = stem[:-len("0")] + str(number) + ending
        if os.path.exists(path):
            os.remove(path)
