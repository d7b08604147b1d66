"""Changes a scene while its views are rendered, and restores it afterwards."""

import math
from contextlib import ExitStack, contextmanager

import bpy


@contextmanager
def changed(thing, **values):
    """Sets properties to other values for a while."""
    before = {name: getattr(thing, name) for name in values}
    try:
        for name, value in values.items():
            setattr(thing, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(thing, name, value)


@contextmanager
def other_files(settings, **values):
    """Changes the image_settings of a render for a while. With the format
    Blender also changes the colours of the files."""
    colours = getattr(settings, "linear_colorspace_settings", None)
    name = colours.name if colours else ""
    try:
        with changed(settings, **values):
            yield
    finally:
        if name:
            colours.name = name


@contextmanager
def still_camera(scene):
    """Replaces the scene's camera for a while by one without animation and
    depth of field. Markers drop their cameras meanwhile; otherwise the render
    would switch to one of them."""
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
    must first be told of several layers, and it stores them as parts of a file
    unless told to interleave."""
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
def colour_and_depth(layer, noisy):
    """Switches off all other passes of a view layer for a while, except its
    AOVs and light groups, which have no switch; with `noisy` also except what
    Cycles rendered before denoising, which brings the denoiser's guides."""
    with ExitStack() as stack:
        for owner in (layer, layer.cycles, layer.eevee):
            names = [prop.identifier for prop in owner.bl_rna.properties
                     if prop.identifier.startswith("use_pass_")
                     or prop.identifier == "denoising_store_passes"]
            stack.enter_context(changed(owner, **{
                name: name in ("use_pass_combined", "use_pass_z") or (
                    noisy and name == "denoising_store_passes")
                for name in names}))
        yield


@contextmanager
def render_settings(scene, size, multilayer=False, codec="ZIP", noisy=False):
    """Sets the output for a while: EXR with depth, this size, only the
    views; with `noisy`, each view also as it was before denoising. The
    denoiser then does not denoise its guides first, which would cost as much
    as the rays: at small sizes it gains 0.1 to 0.4 dB."""
    render = scene.render
    with ExitStack() as stack:
        if noisy:
            stack.enter_context(changed(scene.cycles,
                                        denoising_prefilter="FAST"))
        stack.enter_context(other_files(
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
                                else colour_and_depth(layer, noisy))
            if multilayer and noisy:
                stack.enter_context(changed(layer.cycles,
                                            denoising_store_passes=True))
        yield


def samples_of(scene):
    """Samples per pixel of the scene's picture."""
    return (scene.cycles.samples if scene.render.engine == "CYCLES"
            else scene.eevee.taa_render_samples)


@contextmanager
def finer(scene, supersample, moments=1):
    """Divides the samples per pixel for a while by the number of sub-pixels,
    and by that of a shutter's moments. Each part of a pixel may have more
    noise by the root of their number, so that adaptive sampling takes as many
    rays for the picture as before."""
    parts, samples = supersample * supersample * moments, samples_of(scene)
    if samples < parts:
        raise ValueError(
            "--supersample %d: %d samples a pixel are too few for %d pixels "
            "in its place" % (supersample, samples, parts)
            if moments == 1 else
            "--shutter %d: %d samples a pixel are too few for %d, one for "
            "each moment and sub-pixel" % (moments, samples, parts))
    fewer, cycles = round(samples / parts), scene.cycles
    if scene.render.engine == "CYCLES":
        change = changed(
            cycles, samples=fewer, adaptive_threshold=min(
                1, cycles.adaptive_threshold * math.sqrt(parts)),
            adaptive_min_samples=cycles.adaptive_min_samples // parts)
    else:
        change = changed(scene.eevee, taa_render_samples=fewer)
    with change:
        yield


@contextmanager
def only_layer(scene, name):
    """Renders only one view layer for a while; without a name, all used
    layers."""
    with ExitStack() as stack:
        for layer in scene.view_layers if name else ():
            stack.enter_context(changed(layer, use=layer.name == name))
        yield
