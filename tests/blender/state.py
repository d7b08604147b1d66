"""The complete state of a scene, to compare before and after."""

import bpy


def values(thing):
    """The simple properties of a thing, and the targets of its pointers."""
    found = {}
    for prop in thing.bl_rna.properties:
        value = getattr(thing, prop.identifier)
        if prop.type in {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}:
            found[prop.identifier] = value if not hasattr(value, "__len__") else tuple(value)
        elif prop.type == "POINTER":
            found[prop.identifier] = str(value)
    return found


def state(scene):
    camera = scene.camera
    things = {"scene": scene, "render": scene.render, "files": scene.render.image_settings, "camera": camera,
              "lens": camera.data, "depth of field": camera.data.dof, "layer": scene.view_layers[0],
              "cycles": scene.cycles, "eevee": scene.eevee, "colours": scene.view_settings, "settings": scene.sparselens,
              "windows": bpy.context.preferences.view}
    things.update({marker.name: marker for marker in scene.timeline_markers})
    found = {(name, prop): value for name, thing in things.items() for prop, value in values(thing).items()}
    found["objects"], found["cameras"] = sorted(bpy.data.objects.keys()), sorted(bpy.data.cameras.keys())
    return found
