"""Two renders through the camera's own lens with independent noise, for
dof-finish."""

from contextlib import contextmanager

from .exr import exr_box
from .temporary_settings import changed, only_layer, render_settings, still_camera
from .kept import is_same_render, manner_attributes, windows
from .shots import shot_of


@contextmanager
def open_lens(camera, shot):
    """Gives the made camera the lens of the shot for a while."""
    with changed(camera.data.dof, use_dof=True,
                 focus_distance=shot.focus_distance,
                 aperture_fstop=shot.fstop, aperture_blades=shot.blades,
                 aperture_rotation=shot.rotation, aperture_ratio=shot.ratio):
        yield


def halves_steps(scene, path_of, eye, manner, view_steps, asked=()):
    """Renders rays_1 and rays_2, with manner.finish samples per pixel in
    total. They have the size of the picture, without sub-pixels and overscan.
    Neither is denoised, because that would leave different noise. With
    `asked`, instead the rectangles of dof-finish --ask, each with its samples:
    rays_1_1, rays_2_1, rays_1_2, ... With manner.keep a render of an earlier
    run stays if it has this camera, lens and samples."""
    shot, cycles = shot_of(scene, eye), scene.cycles
    renders = [(half + 2 * number, name % half, (samples + 2 - half) // 2, box)
               for number, (name, samples, box) in enumerate(
                   asked_renders(asked) or [("rays_%d", manner.finish, None)],
                   1 if asked else 0) for half in (1, 2)]
    with render_settings(scene, shot.size, manner.multilayer), \
            still_camera(scene), only_layer(scene, manner.layer), \
            changed(scene.render, use_persistent_data=True):
        for seed, name, count, box in renders:
            with open_lens(scene.camera, shot), changed(
                    cycles, seed=(cycles.seed + seed) % 2 ** 31,
                    samples=count, use_adaptive_sampling=False,
                    use_denoising=False), changed(
                        scene.render, use_crop_to_border=box is not None):
                path = path_of(name)
                attributes = windows(shot.size, 0) | manner_attributes(
                    scene, manner.layer, manner.multilayer)
                if box:
                    x0, y0, x1, y1 = box
                    attributes["dataWindow"] = exr_box(
                        x0, y0, x1 - x0 + 1, y1 - y0 + 1)
                if manner.keep and is_same_render(path, shot, attributes):
                    continue
                yield from view_steps(
                    scene, path, shot, (0, 0), 0, box, attributes,
                    plain=not manner.multilayer)


def asked_renders(asked):
    """Name, samples and box, corners included, of each rectangle."""
    return [("rays_%%d_%d" % number, samples,
             (x, y, x + width - 1, y + height - 1))
            for number, (x, y, width, height, samples)
            in enumerate(asked, 1)]


def curves_of(action):
    """The curves of an action; in Blender 5 they are in layers."""
    if action is None:
        return []
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips
            for bag in strip.channelbags for curve in bag.fcurves]


def check_halves(scene, moments=1):
    """Raises ValueError if both renders would have the same noise, or show no
    motion where the picture does."""
    if moments > 1:
        raise ValueError("finishing: its renders show one moment: set the "
                         "moments of the shutter to 1")
    if scene.render.engine != "CYCLES":
        raise ValueError("finishing: only Cycles renders depth of field by "
                         "rays: choose it as the render engine")
    animation = scene.animation_data
    moved = [] if animation is None else (list(animation.drivers)
                                          + curves_of(animation.action))
    if any(curve.data_path == "cycles.seed" for curve in moved):
        raise ValueError("finishing: the scene's seed is animated, so both "
                         "renders would have the same: use the animated seed "
                         "of Cycles (Sampling > Advanced) in its place")


def check_looks(words):
    """Raises ValueError if the gathered picture would have a look that the
    renders cannot have and would undo."""
    looks = [word for word in words
             if word.startswith("--") and word.split("=")[0] != "--quality"]
    if looks:
        raise ValueError("finishing: Blender's lens has no %s: remove it from "
                         "the looks" % ", ".join(looks))
