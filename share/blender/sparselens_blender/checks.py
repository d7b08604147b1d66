"""Checks for features of a scene that its views cannot show."""

from .shots import border_box


def parts_of(collection):
    """A view layer's collection and all collections within it, except excluded
    ones."""
    if not collection.exclude:
        yield collection
        for child in collection.children:
            yield from parts_of(child)


def holds_out(material):
    return material is not None and material.node_tree is not None and any(
        node.type == "HOLDOUT" for node in material.node_tree.nodes)


def holdout_of(layer):
    """What cuts holes into a view layer, in words; None if nothing does."""
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
    """Whether Cycles lacks its denoiser. It would then end with an error."""
    if scene.render.engine != "CYCLES" or not scene.cycles.use_denoising:
        return False
    import _cycles
    return (scene.cycles.denoiser != "OPTIX"
            and not getattr(_cycles, "with_openimagedenoise", True))


def check_scene(scene, moments=1):
    """Raises ValueError, which says what to change, if the scene cannot be
    rendered. Returns warnings about it."""
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
    if scene.render.use_motion_blur and moments == 1:
        warnings.append("motion blur is on: objects blur, but the camera "
                        "stands still in each view: --shutter 4 renders four "
                        "moments in its place")
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
                        "one out by the other (--holdout; docs/comp.md)")
    return warnings
