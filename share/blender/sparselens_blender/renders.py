"""Renders the views of frames into a folder.

Rendering is a generator: it prepares the scene for a view, and yields; the
caller then renders, at once or in Blender's own time, and asks for the next
step. When the generator ends or is closed, the scene is restored.
"""

import math
import os
import sys
from contextlib import ExitStack
from dataclasses import replace

import bpy

from .chain import Chain
from .checks import check_scene
from .exr import exr_int
from .temporary_settings import (
    changed, finer, only_layer, render_settings, still_camera)
from .halves import check_halves, halves_steps
from .kept import (
    check_scene_of, denoises, is_kept, is_kept_volume, manner_attributes,
    of_other_file, overscan_of_file, part_attributes, windows)
from .layers import parts_of, shown_alone
from .one_view import overscan_steps, view_steps
from .shots import camera_attributes, eyes_of, shot_of
from .shutter import at_moment, forget_more, moments_of, of_moment
from .sub_pixels import AUTO, supersample_steps
from .volumes import check_slices, without_volumes

# Noise of one seed would look like something at infinity that all views show.
VIEW_SEEDS_APART = 1000003


def warn(text):
    print("sparselens_views.py: warning:", text, file=sys.stderr)


def folder_of(path):
    """The full name of a folder; // stands for the folder of the .blend
    file, {blend_name} for its name without the ending."""
    if not path.strip():
        raise ValueError("no folder is chosen for the views: choose one, such "
                         "as //views/")
    if path.startswith("//") and not bpy.data.filepath:
        raise ValueError("'%s' is a folder beside the .blend file, which is "
                         "not saved yet: save it, or choose another folder"
                         % path)
    name = os.path.splitext(os.path.basename(bpy.data.filepath))[0]
    return os.path.abspath(bpy.path.abspath(
        path.replace("{blend_name}", name or "unsaved")))


def used_layers(scene):
    return [layer.name for layer in scene.view_layers if layer.use]


def layer_to_render(scene, name, multilayer, say=warn):
    """The name of the only view layer to render, or None for all. Reports
    layers that will not be written."""
    names = [layer.name for layer in scene.view_layers]
    if name and name not in names:
        raise ValueError("--layer: the scene has no view layer '%s'; it has: "
                         "%s" % (name, ", ".join(names)))
    used = used_layers(scene)
    if not name and not multilayer and len(used) > 1:
        say("the scene renders %d view layers, %s, of which the files hold "
            "'%s' alone: choose one by --layer, or take all by --multilayer"
            % (len(used), ", ".join(used), used[0]))
    return name or (None if multilayer else used[0])


def eye_steps(scene, folder, ending, views, eye, manner, count):
    """All renders of one eye at the current frame, or at a moment of it."""
    def path_in(part):
        return lambda name: manner.path(os.path.join(
            folder, part.folder, name + eye.file_suffix + ending))

    parts = parts_of(scene, manner.layers)
    if manner.moment and manner.moment.number == 0:
        for part in parts:
            for name in [name for name, _, _ in views] + ["volume"]:
                forget_more(path_in(part)(name), manner.shutter)
    for part in parts:
        os.makedirs(os.path.join(folder, part.folder), exist_ok=True)
        with ExitStack() as stack:
            stack.enter_context(shown_alone(scene, part))
            if manner.slices:
                stack.enter_context(without_volumes())
            yield from part_steps(scene, path_in(part), views, eye, manner,
                                  part, count)
    if manner.slices and "center" in [name for name, _, _ in views]:
        yield from volume_steps(scene, path_in(parts[0]), eye, manner,
                                parts[0], count)


def volume_steps(scene, path_of, eye, manner, rest, count):
    """The deep view of the volumes, with the windows of the centre view."""
    from .slices import slice_steps  # needs NumPy, which takes long to load
    center, path = path_of("center"), path_of("volume")
    shot = shot_of(scene, eye, manner.supersample)
    beyond = overscan_of_file(center)
    attributes = manner_attributes(
        scene, manner.layer, False, rest.words) | windows(
            shot.size, beyond) | manner.attributes | {
                "sparselens:slices": exr_int(manner.slices)}
    if manner.keep and is_kept_volume(path, shot, attributes):
        count.keep([path])
        return
    with only_layer(scene, manner.layer), \
            finer(scene, manner.supersample, manner.shutter):
        yield from slice_steps(
            scene, path, center, shot, beyond, manner, rest.unseen,
            attributes | camera_attributes(shot, shot.placement))
    count.note(path)


def part_steps(scene, path_of, views, eye, manner, part, count):
    """The views of a part of the scene."""
    finest = manner.supersample
    shot = shot_of(scene, eye, finest)
    words = filter(None, [part.words, manner.slices and "without volumes"])
    attributes = manner_attributes(scene, manner.layer, manner.multilayer,
                                   ", ".join(words)) | manner.attributes
    if not part.alone:
        attributes |= part_attributes(manner)
    pixels = manner.overscan
    if pixels == AUTO:
        center = path_of("center")
        if manner.keep and is_kept(center, shot, (0, 0), attributes):
            pixels = overscan_of_file(center) // finest
        else:
            pixels = manner.overscans.get(center)
            if pixels is None:
                with only_layer(scene, manner.layer):
                    needed = yield from overscan_steps(
                        scene, os.path.dirname(center), shot,
                        used_layers(scene))
                pixels = math.ceil(needed / finest)
            print("sparselens: frame %g%s: overscan of %d pixels" % (
                manner.moment.time if manner.moment else scene.frame_current,
                eye.name and ", " + eye.name, pixels))
    beyond = pixels * finest
    attributes |= windows(shot.size, beyond)
    kept = {name for name, u, _ in views if manner.keep
            and is_kept(path_of(name), shot, u, attributes)}
    count.keep([path_of(name) for name in kept])
    left = [(number, name, u, box) for number, (name, u, box) in
            enumerate(views, 1) if name not in kept]
    size = [side + 2 * beyond for side in shot.size]
    with ExitStack() as stack:
        if left:
            stack.enter_context(render_settings(
                scene, size, manner.multilayer, noisy=denoises(scene)))
            stack.enter_context(still_camera(scene))
            stack.enter_context(only_layer(scene, manner.layer))
            stack.enter_context(finer(scene, finest, manner.shutter))
        for number, name, u, box in left:
            by = VIEW_SEEDS_APART * (number if name != "center" else 0)
            with changed(scene.cycles,
                         seed=(scene.cycles.seed + by) % 2 ** 31):
                yield from view_steps(
                    scene, path_of(name), shot, u, beyond, box, attributes,
                    plain=not manner.multilayer)
            count.note(path_of(name))


def frame_ending(frame, several):
    """The ending of the names of a frame's files."""
    return ".%04d.exr" % frame if several else ".exr"


def centers_in(folder, eyes, endings):
    """Where the centre views go, and those of first moments."""
    for ending in endings:
        for eye in eyes:
            center = os.path.join(folder, "center" + eye.file_suffix + ending)
            yield from (center, of_moment(center, 0))


def check_folder(folder, eyes, frames, several):
    """Raises ValueError if views of another .blend file are where those of
    this one would go."""
    found = of_other_file(centers_in(
        folder, eyes, [frame_ending(frame, several) for frame in frames]))
    if found:
        raise ValueError("%s: choose another folder for the views of %s, or "
                         "delete those that are there"
                         % (found, os.path.basename(bpy.data.filepath)))


def settle_supersample(scene, folder, frames, several, manner):
    """Sets `supersample` if it is AUTO: to the most that the first, the middle
    and the last frame need, so that it does not change within a shot."""
    if manner.supersample != AUTO:
        return
    found, eye = 1, eyes_of(scene)[0]
    for frame in sorted({frames[0], frames[len(frames) // 2], frames[-1]}):
        scene.frame_set(frame)
        moment = next(iter(moments_of(scene, frame, manner.shutter)))
        center = replace(manner, moment=moment).path(os.path.join(
            folder, "center" + eye.file_suffix + frame_ending(frame, several)))
        with at_moment(scene, moment), only_layer(scene, manner.layer):
            number, pixels = yield from supersample_steps(
                scene, center, eye, manner.keep, used_layers(scene),
                manner.shutter)
        found = max(found, number)
        if pixels is not None and not (manner.slices or manner.layers):
            manner.overscans[center] = pixels
    manner.supersample = found


def views_steps(scene, frames, folder, views_at, eyes, manner, count,
                several=False, say=warn, shot=()):
    """The views of a list of frames; views_at(frame) returns those of one
    frame. With `several` the names carry the frame's number. Warnings go to
    `say`, once for all frames. `shot`: all frames of the shot, if they are
    more. Yields the renders, in words."""
    for text in check_scene(scene, manner.shutter):
        say(text)
    if manner.finish:
        check_halves(scene, manner.shutter)
    manner.layer = layer_to_render(scene, manner.layer, manner.multilayer, say)
    if manner.slices:
        check_slices(scene, [manner.layer] if manner.layer
                     else used_layers(scene))
    parts, every = parts_of(scene, manner.layers), list(shot or frames)
    centers = list(centers_in(folder, eyes, [
        frame_ending(frame, several) for frame in frames]))
    for path in centers:
        check_scene_of(path, scene)
    found = of_other_file(centers)
    if found:
        say(found)
    os.makedirs(folder, exist_ok=True)
    before, within = scene.frame_current, scene.frame_subframe
    stack = ExitStack()
    try:
        # Most renders differ from the one before in the camera alone.
        stack.enter_context(changed(scene.render, use_persistent_data=True))
        yield from settle_supersample(
            scene, folder, shot or frames, several, manner)
        for frame in frames:
            scene.frame_set(frame)
            views, ending = views_at(frame), frame_ending(frame, several)
            count.expect(len(eyes) * manner.shutter * (
                len(views) * len(parts) + (manner.slices > 0)),
                len(every) - every.index(frame))
            for moment in moments_of(scene, frame, manner.shutter):
                with at_moment(scene, moment):
                    for eye in eyes:
                        yield from eye_steps(
                            scene, folder, ending, views, eye,
                            replace(manner, moment=moment), count)
            for eye in eyes if manner.finish else ():
                yield from halves_steps(
                    scene, lambda name: os.path.join(
                        folder, name + eye.file_suffix + ending),
                    eye, manner, view_steps)
    finally:
        stack.close()
        if (scene.frame_current, scene.frame_subframe) != (before, within):
            scene.frame_set(before, subframe=within)


def render_now(scene, steps):
    """Renders, and waits for tools, without a window."""
    for step in steps:
        if isinstance(step, Chain):
            step.wait()
        else:
            bpy.ops.render.render(write_still=True, scene=scene.name)
