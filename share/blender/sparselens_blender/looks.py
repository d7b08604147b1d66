"""Looks of real lenses that Blender's camera does not have, as fields of the
panel. looks.json has their names, ranges and help;
tests/tools/blender-looks.sh compares it with what the tools say."""

import json
import os
import shlex

import bpy

with open(os.path.join(os.path.dirname(os.path.realpath(__file__)),
                       "looks.json"), encoding="utf-8") as file:
    ALL = json.load(file)

FILES = {"lens": "Lens file with looks, such as those in share/lenses; the "
                 "fields override it",
         "aperture": "Picture of the aperture (EXR), in the place of the "
                     "camera's blades"}


def field_of(name):
    return name.replace("-", "_")


def property_of(look):
    words = {"name": look["label"][0].upper() + look["label"][1:],
             "description": look["help"]}
    if look["control"] == "number":
        return bpy.props.FloatProperty(
            default=look["usual"], soft_min=look["low"],
            soft_max=look["high"], step=5, precision=3, **words)
    if look["control"] == "pair":
        return bpy.props.FloatVectorProperty(
            size=2, soft_min=-60, soft_max=60, step=50, **words)
    if look["words"] == ["on"]:
        return bpy.props.BoolProperty(**words)
    return bpy.props.EnumProperty(
        items=[(word, word, "") for word in look["words"]], **words)


def properties():
    """The annotations of a PropertyGroup that has all looks."""
    found = {field_of(look["name"]): property_of(look) for look in ALL}
    for name, help_text in FILES.items():
        found[name] = bpy.props.StringProperty(
            name=name.capitalize() + " File", description=help_text,
            subtype="FILE_PATH")
    return found


def value_words(look, value):
    """The value as words of dof-gather, after the option's name."""
    if look["control"] == "number":
        return ["%.6g" % value]
    if look["control"] == "pair":
        return [",".join("%.6g" % part for part in value)]
    return [] if value is True else [value]


def words_of(group):
    """The looks as options of dof-gather; fields that have not been changed
    are left out."""
    words = []
    for name in FILES:
        path = getattr(group, name)
        if path:
            words += ["--" + name, os.path.abspath(bpy.path.abspath(path))]
    for look in ALL:
        field = field_of(look["name"])
        if not is_usual(group, field) and not lacks_gain(group, field):
            words += ["--" + look["name"],
                      *value_words(look, getattr(group, field))]
    return words


def is_usual(group, field):
    kind, value = group.bl_rna.properties[field], getattr(group, field)
    if getattr(kind, "is_array", False):
        return list(value) == list(kind.default_array)
    return value == kind.default


def lacks_gain(group, field):
    """Whether the field says which lights become brighter, but none do."""
    return (field in ("highlight_threshold", "highlight_knee")
            and is_usual(group, "highlight_gain"))


def looks_of(settings):
    """All options of the panel for the lens: the looks, then the options that
    are typed."""
    try:
        typed = shlex.split(settings.looks)
    except ValueError as error:
        raise ValueError("Other Options: %s: %s" % (
            settings.looks, error)) from error
    return words_of(settings.lens_looks) + typed
