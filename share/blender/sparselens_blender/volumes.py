"""The volumes of a scene, for Cycles: which objects have them, where they are,
and how to show the scene without them or them alone.
"""

from contextlib import ExitStack, contextmanager

import bpy
from mathutils import Vector

from .temporary_settings import changed


def has_volume(tree):
    return tree is not None and any(
        node.type in ("OUTPUT_MATERIAL", "OUTPUT_WORLD")
        and node.inputs["Volume"].is_linked for node in tree.nodes)


def has_surface(material):
    tree = material.node_tree if material.use_nodes else None
    return tree is None or any(
        node.type == "OUTPUT_MATERIAL" and node.inputs["Surface"].is_linked
        for node in tree.nodes)


def is_only_volume(thing):
    """Whether an object shows nothing but volumes."""
    if thing.type == "VOLUME":
        return True
    materials = [slot.material for slot in thing.material_slots
                 if slot.material]
    return bool(materials) and any(
        has_volume(material.node_tree) for material in materials) and not any(
            has_surface(material) for material in materials)


def holds_volume(thing):
    return thing.type == "VOLUME" or any(
        slot.material and has_volume(slot.material.node_tree)
        for slot in thing.material_slots)


@contextmanager
def without_volumes():
    """Hides the volumes from the rays of the camera for a while. Hidden
    objects would not do: what is inside a volume would lose its shadow."""
    made = []
    try:
        for owner in [*bpy.data.materials, *bpy.data.worlds]:
            tree = owner.node_tree if owner.use_nodes else None
            for output in tree.nodes if has_volume(tree) else ():
                if (output.type not in ("OUTPUT_MATERIAL", "OUTPUT_WORLD")
                        or not output.inputs["Volume"].is_linked):
                    continue
                socket = output.inputs["Volume"]
                source = socket.links[0].from_socket
                path = tree.nodes.new("ShaderNodeLightPath")
                mix = tree.nodes.new("ShaderNodeMixShader")
                made.append((tree, source, socket, path, mix))
                tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
                tree.links.new(source, mix.inputs[1])
                tree.links.new(mix.outputs[0], socket)
        yield
    finally:
        for tree, source, socket, path, mix in made:
            tree.links.new(source, socket)
            tree.nodes.remove(path)
            tree.nodes.remove(mix)


@contextmanager
def only_volumes(scene, unseen):
    """Lets the camera see volumes only, for a while: lights and the objects of
    `unseen` are invisible to it, all others are holdouts."""
    with ExitStack() as stack:
        stack.enter_context(changed(scene.render, film_transparent=True))
        stack.enter_context(changed(scene.cycles, use_denoising=False,
                                    film_transparent_glass=False))
        for thing in bpy.data.objects:
            if thing.type == "LIGHT" or thing in unseen:
                stack.enter_context(changed(thing, visible_camera=False))
            elif not is_only_volume(thing):
                stack.enter_context(changed(thing, is_holdout=True))
        yield


def instances(layer):
    """Pairs (object, its matrix) of everything that is rendered in a view
    layer; also of objects that are hidden in the viewport."""
    for thing in layer.objects:
        if not thing.hide_render:
            yield thing, thing.matrix_world
    for made in bpy.context.evaluated_depsgraph_get().object_instances:
        if made.is_instance:
            yield made.object, made.matrix_world


def box_depths(corners, shot, grown):
    """The nearest and farthest depth of a box, given by its corners in the
    space of the camera; None where the camera does not see it. `grown`: the
    picture with its overscan, in widths of the picture."""
    depths = [-corner.z for corner in corners]
    nearest = max(min(depths), shot.clip[0])
    farthest = min(max(depths), shot.clip[1])
    if farthest <= nearest:
        return None
    field = shot.sensor_width / shot.focal_length
    height = shot.size[1] / (shot.size[0] * shot.pixel_aspect)
    for axis, side in enumerate((1, height)):
        beyond = shot.lens_radius
        for sign in -1, 1:
            edge = field * (side * grown / 2 + sign * shot.shift[axis])
            if all(sign * corner[axis] - beyond > edge * max(depth, 0)
                   for corner, depth in zip(corners, depths)):
                return None
    return nearest, farthest


def volume_depths(scene, layer, shot, grown):
    """The ranges of depth that hold volumes, which do not overlap, from the
    bounds of the objects; all that the camera sees for a world's volume."""
    if scene.world and scene.world.use_nodes and has_volume(
            scene.world.node_tree):
        return [shot.clip]
    to_camera = shot.placement.inverted()
    found = []
    for thing, matrix in instances(layer):
        if holds_volume(thing):
            found.append(box_depths(
                [to_camera @ matrix @ Vector(corner)
                 for corner in thing.bound_box], shot, grown))
    ranges = []
    for near, far in sorted(filter(None, found)):
        if ranges and near <= ranges[-1][1]:
            ranges[-1] = ranges[-1][0], max(far, ranges[-1][1])
        else:
            ranges.append((near, far))
    return ranges


def check_slices(scene, layers):
    """Raises ValueError if the scene's volumes cannot be rendered in
    slices."""
    if scene.render.engine != "CYCLES":
        raise ValueError("--slices: only Cycles renders them: choose it as "
                         "the render engine")
    if len(layers) > 1:
        raise ValueError("--slices: the scene renders %d view layers, %s: "
                         "choose one by --layer" % (len(layers),
                                                    ", ".join(layers)))
    volumes = [thing.name for thing in bpy.data.objects
               if not thing.hide_render and holds_volume(thing)]
    world = scene.world and scene.world.use_nodes and has_volume(
        scene.world.node_tree)
    if not volumes and not world:
        raise ValueError("--slices: no material of the scene has a volume")
