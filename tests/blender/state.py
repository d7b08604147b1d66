"""All properties of all data of the file, to compare before and after: scenes, objects, materials with their nodes, and
so on, but not the windows. What the add-on makes is left out: pictures that it shows, and its node group with the
pictures in it.
"""

import os

import bpy

WINDOWS = {"screens", "workspaces", "window_managers"}
# Counters, and what Blender computes from the rest, such as matrices of scenes that it evaluates later; the pixels of
# pictures; a list of rules for other programs; and settings of a brush, at which Blender 4.2 crashes if it has none.
VOLATILE = {"rna_type", "bl_rna", "users", "session_uid", "is_updated", "is_dirty", "pixels", "depsgraph", "bl_icon",
            "original", "has_data", "id_data", "matrix_world", "matrix_local", "uv_sculpt"}
LONG = 200  # of a longer list, such as a mesh's vertices, which no operator edits, only the length is compared
SIMPLE = {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}


def plain(value):
    """A copy of a value: Blender's vectors show what the property has later."""
    return tuple(map(plain, value)) if hasattr(value, "__len__") and not isinstance(value, str) else value


def walk(thing, path, found, within):
    """Adds the properties of a thing, and of what belongs to it, but not of other data that it points at."""
    key = thing.as_pointer(), type(thing).__name__
    if key in within:
        return
    within = within | {key}
    for prop in thing.bl_rna.properties:
        name = prop.identifier
        if name in VOLATILE:
            continue
        try:
            value = getattr(thing, name)
        except Exception:  # Blender has properties that cannot be read
            continue
        below = "%s.%s" % (path, name)
        if prop.type in SIMPLE:
            found[below] = sorted(value) if isinstance(value, set) else plain(value)
        elif prop.type == "POINTER" and value is not None:
            point(value, below, found, within)
        elif prop.type == "COLLECTION":
            found[below] = len(value)
            for number, item in enumerate(value if len(value) <= LONG else ()):
                if item is not None:
                    point(item, "%s[%d]" % (below, number), found, within)


def point(value, path, found, within):
    if isinstance(value, bpy.types.ID) and not value.is_embedded_data:
        found[path] = repr(value)
    else:
        walk(value, path, found, within)


def is_result(data):
    if isinstance(data, bpy.types.Image):
        return (data.get("sparselens") is not None or data.type in {"RENDER_RESULT", "COMPOSITING"}
                or os.path.basename(data.filepath).startswith("picture."))
    return isinstance(data, bpy.types.NodeTree) and data.name == "Sparse lens"


def state(scene):
    for other in bpy.data.scenes:
        for layer in other.view_layers:
            layer.update()
    found = {"scene": repr(scene)}
    walk(bpy.context.preferences.view, "preferences", found, frozenset())
    for prop in bpy.data.bl_rna.properties:
        if prop.type == "COLLECTION" and prop.identifier not in WINDOWS:
            for data in getattr(bpy.data, prop.identifier):
                if not is_result(data):
                    walk(data, repr(data), found, frozenset())
    return found


def changes(before, after):
    """Triples of a property and its two values."""
    return [(key, before.get(key), after.get(key)) for key in sorted(before.keys() | after.keys())
            if before.get(key) != after.get(key)]
