"""See-through things in layers of their own, because a flat view has one depth
in each pixel: either that of a film or that of what is seen through it.
"""

import re
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import bpy

from .temporary_settings import changed


@dataclass(frozen=True)
class Part:
    """The part of the scene that one set of views shows."""

    folder: str = ""  # of its views, within the folder of all
    words: str = ""   # for sparselens:rendered
    unseen: frozenset = frozenset()  # objects that it does not show
    alone: bool = False  # a see-through thing over nothing


def names_of(text):
    """The names in a list with commas."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def objects_named(scene, name):
    """The objects of the scene's object or collection with this name."""
    collection = next((found for found in scene.collection.children_recursive
                       if found.name == name), None)
    if collection:
        return frozenset(collection.all_objects)
    if name in scene.objects:
        return frozenset([scene.objects[name]])
    raise ValueError("--layers: the scene has no object and no collection "
                     "'%s'" % name)


def folder_named(name):
    """The name as one of a folder, in characters that no shell treats
    differently."""
    return re.sub(r"[^\w-]", "_", name)


def parts_of(scene, names):
    """The rest of the scene, and each named thing; just the whole scene if
    nothing is named."""
    if not names:
        return [Part()]
    named = [objects_named(scene, name) for name in names]
    folders = [folder_named(name) for name in names]
    if len(set(folders)) < len(folders):
        raise ValueError("--layers: two of the layers %s would have one "
                         "folder" % ", ".join(names))
    everything = frozenset(bpy.data.objects)
    return [Part("", "without " + ", ".join(names),
                 frozenset().union(*named))] + [
        Part(folder, name + " alone", everything - objects, True)
        for folder, name, objects in zip(folders, names, named)]


@contextmanager
def shown_alone(scene, part):
    """Hides from the camera, for a while, what is not of the part. The depth
    of a see-through thing is then its own, however little it covers."""
    with ExitStack() as stack:
        for thing in part.unseen:
            stack.enter_context(changed(thing, visible_camera=False))
        if part.alone:
            stack.enter_context(changed(scene.render, film_transparent=True))
            for layer in scene.view_layers:
                stack.enter_context(changed(layer, pass_alpha_threshold=0))
        yield
