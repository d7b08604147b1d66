"""Decides which views of an earlier run stay: those of this camera, rendered
as they would be now. Other changes of the scene leave no trace in a file.
"""

import os
import struct
from dataclasses import replace

import bpy

from .exr import exr_box, exr_int, exr_text, read_header
from .temporary_settings import samples_of
from .layers import folder_named
from .shots import camera_attributes, view_placement

NAMES = {"Camera", "sparselens:scene", "sparselens:file"}  # may change

# The lens may change afterwards, but it must not become wider than the views.
OF_THE_LENS = {"aperture", "focus", "aperture_blades", "aperture_rotation",
               "aperture_ratio"}


def denoises(scene):
    return scene.render.engine == "CYCLES" and scene.cycles.use_denoising


def manner_attributes(scene, layer, multilayer, more=""):
    """The frame, and in words how its views are rendered; `more`: further
    words."""
    words = [scene.render.engine, "%d samples" % samples_of(scene)]
    if denoises(scene):
        words.append("denoised, noise kept")
    words += [layer] if layer else []
    words += ["all passes"] if multilayer else []
    words += [more] if more else []
    return {"sparselens:frame": exr_int(scene.frame_current),
            "sparselens:rendered": exr_text(", ".join(words))}


def part_attributes(manner):
    """What belongs to the picture besides the views: the deep view of the
    volumes, and the folders of see-through layers."""
    values = {"sparselens:volume": "volume" if manner.slices else "",
              "sparselens:layers": " ".join(map(folder_named, manner.layers))}
    return {name: exr_text(value) for name, value in values.items() if value}


def parts_of_file(path):
    """The folders of see-through layers of a centre view, and the name of the
    deep view of volumes, if there are any."""
    header = header_of(path) or {}
    return [header.get("sparselens:" + name, ("", b""))[1].decode().split()
            for name in ("layers", "volume")]


def windows(size, overscan):
    """The display window of a picture, and a data window that is larger by
    `overscan` on each side."""
    width, height = size
    return {"displayWindow": exr_box(0, 0, width, height),
            "dataWindow": exr_box(-overscan, -overscan, width + 2 * overscan,
                                  height + 2 * overscan)}


def header_of(path, deep=False):
    """The attributes of an EXR file; None if it cannot be read."""
    try:
        with open(path, "rb") as file:
            for most in 1 << 16, -1:  # few headers are longer
                file.seek(0)
                try:
                    return read_header(file.read(most), deep)[0]
                except (IndexError, struct.error):
                    continue
                except ValueError:
                    if most < 0:
                        return None
    except OSError:
        pass
    return None


def floats(header, name):
    kind, value = header[name]
    return struct.unpack("<%df" % (len(value) // 4), value)


def overscan_of_file(path):
    """Overscan of a view on each side, in pixels of the view."""
    header = header_of(path)
    if header is None:
        return None
    return -struct.unpack("<4i", header["dataWindow"][1])[0]


def supersample_of(header):
    kind, value = header.get("ldi.supersample", ("", b""))
    return struct.unpack("<i", value)[0] if kind == "int" else 1


def is_of_camera(header, shot, u=(0, 0), wider=False):
    """Whether a view was seen from point u of this camera's lens, or of one at
    least as wide; with `wider` this lens may also be the wider one."""
    try:
        fstop, = floats(header, "aperture")
    except (KeyError, ValueError, struct.error):
        return False
    then = replace(shot, fstop=fstop)
    wanted = camera_attributes(then, view_placement(then, u))
    wanted["displayWindow"] = exr_box(0, 0, *shot.size)
    return (fstop <= shot.fstop or wider) and all(
        header.get(name) == value for name, value in wanted.items()
        if name not in OF_THE_LENS | NAMES)


def check_scene_of(path, scene):
    """Raises ValueError if the view in this file is of another scene of the
    .blend file: it may be neither used nor overwritten. A name that no scene
    has is the former name of one that was renamed."""
    header = header_of(path) or {}
    name = header.get("sparselens:scene", ("", b""))[1].decode()
    if name != scene.name and name in bpy.data.scenes:
        raise ValueError("%s is a view of scene '%s': choose another folder "
                         "for the views of scene '%s'"
                         % (path, name, scene.name))


def of_other_file(paths):
    """The first of these files that is a view of another .blend file, in
    words; None if there is none. The name of a file that is not beside this
    one is the former name of one that was renamed or moved."""
    folder, own = os.path.split(bpy.data.filepath)
    for path in paths:
        header = header_of(path) or {}
        name = header.get("sparselens:file", ("", b""))[1].decode()
        if own and name not in ("", own) and os.path.exists(
                os.path.join(folder, name)):
            return "%s is a view of %s" % (path, name)
    return None


def is_kept(path, shot, u, others):
    """Whether the view in this file can stay: it is of this camera, and has
    these other attributes."""
    header = header_of(path)
    return header is not None and is_of_camera(header, shot, u) and all(
        header.get(name) == value for name, value in others.items())


def is_kept_volume(path, shot, others):
    """Whether the deep view of the volumes in this file can stay."""
    header = header_of(path, deep=True)
    return (header is not None and is_of_camera(header, shot, wider=True)
            and all(header.get(name) == value
                    for name, value in others.items()))


def is_same_render(path, shot, others):
    """Whether a render through the lens can stay: it is of this camera, with
    exactly this lens, and has these other attributes."""
    header = header_of(path)
    wanted = camera_attributes(shot, shot.placement) | others
    return header is not None and all(
        header.get(name) == value for name, value in wanted.items()
        if name not in NAMES)
