"""The pictures of the views: their files, and the commands that make them."""

import math
import os
import struct
from dataclasses import dataclass

from . import tools
from .kept import header_of, is_of_camera


@dataclass
class Files:
    """The files of an eye at a frame."""

    folder: str
    suffix: str  # of the eye
    ending: str  # .exr, or with the frame's number before it
    rim: int     # views from the rim of the lens

    def path(self, name):
        return os.path.join(self.folder, name + self.suffix + self.ending)

    @property
    def views(self):
        return [self.path("center")] + [self.path("view_%d" % number)
                                        for number in range(self.rim)]


def frame_of(header):
    kind, value = header.get("sparselens:frame", ("", b""))
    return struct.unpack("<i", value)[0] if kind == "int" else None


def files_to_take(scene, folder, eye, rim, shot):
    """The files of the current frame's views: those with its number, or else
    those without any. Raises ValueError where they are not there, or not of
    this frame and camera."""
    ask = ": press Render Views"
    found = None
    for ending in ".%04d.exr" % scene.frame_current, ".exr":
        files = Files(folder, eye.file_suffix, ending, rim)
        if os.path.exists(files.views[0]):
            found = files
            break
    if found is None:
        raise ValueError("%s is not there%s" % (files.views[0], ask))
    for path in found.views:
        header = header_of(path)
        if header is None:
            raise ValueError("%s is not there, or is not whole%s"
                             % (path, ask))
        frame = frame_of(header)
        if frame not in (None, scene.frame_current):
            raise ValueError("%s shows frame %d, not %d%s" % (
                path, frame, scene.frame_current, ask))
    check_camera(found.views[0], shot, ask)
    return found


def check_camera(center, shot, ask):
    """The lens may be set anew, but the camera has to be where it was. A lens
    that is opened wider has other views, and the tools warn of that."""
    header = header_of(center)
    if not is_of_camera(header, shot, wider=True):
        raise ValueError("camera '%s' has been moved or changed, or the "
                         "picture's size, since %s was rendered%s"
                         % (shot.camera, center, ask))


def number(value):
    """All digits, so that a tool reads what Blender has."""
    return repr(float(value))


def lens_options(shot):
    """The camera's lens, as dof-gather is told of it. Cycles takes less than
    three blades for none."""
    return ["--focus-distance", number(shot.focus_distance),
            "--fstop", number(shot.fstop),
            "--blades", str(shot.blades if shot.blades >= 3 else 0),
            "--blade-rotation", number(math.degrees(shot.rotation)),
            "--squeeze", number(shot.ratio)]


def is_newest(path, others):
    try:
        return all(os.path.getmtime(path) >= os.path.getmtime(other)
                   for other in others)
    except OSError:
        return False


def warp_commands(folder, files, layer=None):
    """Make the LDI, unless it is newer than the views; of files with several
    layers it may be that of another."""
    ldi = files.path("ldi")
    if not layer and is_newest(ldi, files.views):
        return []
    return [[tools.tool(folder, "ldi-warp"), *files.views, "-o", ldi,
             *(["--layer", layer] if layer else [])]]


def gather_command(folder, ldi, out, options):
    """Makes a picture of the scene's size, as Blender knows no pixels beyond
    it."""
    return [tools.tool(folder, "dof-gather"), ldi, "-o", out,
            "--overscan", "crop", *options]


def finish_command(folder, files, out):
    """Makes the gathered picture exact by the two renders."""
    return [tools.tool(folder, "dof-finish"), files.path("gathered"),
            files.path("rays_1"), files.path("rays_2"), "-o", out]


DRAFT_WIDTH = 640  # pixels; a wider picture is first shown smaller


def draft_options(width):
    return ["--quality", "draft",
            "--proxy", str(max(1, math.ceil(width / DRAFT_WIDTH)))]

