"""Files of the pictures of the views, and the commands that make them."""

import math
import os
import struct
from dataclasses import dataclass

from . import tools
from .exr import channel_list
from .kept import (
    check_scene_of, header_of, is_of_camera, parts_of_file, supersample_of)
from .shots import shot_of
from .shutter import forget_more, of_moment, shot_of_first
from .sub_pixels import AUTO


@dataclass
class Files:
    """The files of an eye at a frame."""

    folder: str
    suffix: str  # for the eye
    ending: str  # .exr, or the frame's number and .exr
    rim: int     # number of views from the rim of the lens
    moments: int = 1  # of the shutter, each with its views and its LDI

    def path(self, name, part=""):
        return os.path.join(self.folder, part,
                            name + self.suffix + self.ending)

    def of_moments(self, name, part=""):
        """The name as the tools read it: for several moments with %s."""
        path = self.path(name, part)
        return of_moment(path) if self.moments > 1 else path

    def each(self, name, part=""):
        """The file of each moment."""
        path = self.path(name, part)
        return ([of_moment(path, number) for number in range(self.moments)]
                if self.moments > 1 else [path])

    @property
    def names(self):
        return ["center"] + ["view_%d" % number for number in range(self.rim)]

    def views_of(self, part):
        return [self.of_moments(name, part) for name in self.names]

    def each_of(self, part):
        """The file of each view at each moment."""
        return [path for name in self.names for path in self.each(name, part)]


def frame_of(header):
    kind, value = header.get("sparselens:frame", ("", b""))
    return struct.unpack("<i", value)[0] if kind == "int" else None


def files_to_take(scene, folder, eye, rim, supersample, moments=1):
    """The view files of the current frame: those with its number, else those
    without a number; and the camera, with the sub-pixels that the files have,
    if `supersample` is AUTO. Raises ValueError if files are missing, or belong
    to another scene, frame or camera."""
    ask = ": press Render Views"
    found = None
    for ending in ".%04d.exr" % scene.frame_current, ".exr":
        files = Files(folder, eye.file_suffix, ending, rim, moments)
        if os.path.exists(files.each("center")[0]):
            found = files
            break
    if found is None:
        raise ValueError("%s is not there%s" % (files.each("center")[0], ask))
    check_scene_of(found.each("center")[0], scene)
    for path in found.each_of(""):
        header = header_of(path)
        if header is None:
            raise ValueError("%s is not there, or is not whole%s"
                             % (path, ask))
        frame = frame_of(header)
        if frame not in (None, scene.frame_current):
            raise ValueError("%s shows frame %d, not %d%s" % (
                path, frame, scene.frame_current, ask))
    center = found.each("center")[0]
    header = header_of(center)
    finest = supersample_of(header) if supersample == AUTO else supersample
    shot = shot_of(scene, eye, finest)
    check_camera(header, center, shot_of_first(scene, eye, finest, moments),
                 ask)
    return found, shot


def check_camera(header, center, shot, ask):
    """Raises ValueError if the camera has moved since. The lens may differ; if
    it is opened wider than in the views, the tools warn."""
    if not is_of_camera(header, shot, wider=True):
        raise ValueError("camera '%s' has been moved or changed, or the "
                         "picture's size, since %s was rendered%s"
                         % (shot.camera, center, ask))


def number(value):
    """Prints all digits, so that a tool reads the same value as Blender."""
    return repr(float(value))


def lens_options(shot, looks=()):
    """The camera's lens, then the looks, as options of dof-gather. Cycles
    treats less than three blades as none. What the camera does not say of its
    aperture is left to a lens file, and an aperture's picture has no
    blades."""
    blades = shot.blades if shot.blades >= 3 else 0
    aperture = {"--blades": (str(blades), blades == 0),
                "--blade-rotation": (number(math.degrees(shot.rotation)),
                                     shot.rotation == 0),
                "--squeeze": (number(shot.ratio), shot.ratio == 1)}
    if "--aperture" in looks:
        del aperture["--blades"], aperture["--blade-rotation"]
    return ["--focus-distance", number(shot.focus_distance),
            "--fstop", number(shot.fstop),
            *[word for name, (value, usual) in aperture.items()
              if not (usual and "--lens" in looks)
              for word in (name, value)],
            *looks]


def is_newest(path, others):
    try:
        return all(os.path.getmtime(path) >= os.path.getmtime(other)
                   for other in others)
    except OSError:
        return False


def noise_of(path, layer):
    """The name of Cycles' pass with what a denoised view was before; None if
    it has no such pass."""
    ending = ".Noisy Image.R"
    return next((name[:-len(".R")] for name, _ in channel_list(header_of(path))
                 if name.endswith((layer or "") + ending)), None)


def rendered_files(files):
    """All files that Blender has rendered for a picture."""
    layers, volumes = parts_of_file(files.each("center")[0])
    return [view for part in ["", *layers] for view in files.each_of(part)] + [
        path for name in volumes for path in files.each(name)]


def warp_commands(folder, files, layer=None):
    """Commands that make the LDI, none if it is newer than the views. The
    centre view says whether see-through layers and a deep view of the volumes
    belong to it. From files with several layers the LDI is always made,
    because the existing one may be of another layer."""
    layers, volumes = parts_of_file(files.each("center")[0])
    parts, ldis = ["", *layers], files.each("ldi")
    rendered = rendered_files(files)
    if files.moments > 1:
        forget_more(ldis[0], files.moments)
    if not layer and all(is_newest(ldi, rendered) for ldi in ldis):
        return []
    ldi = files.of_moments("ldi")
    volumes = [files.of_moments(name) for name in volumes]
    apart = [files.of_moments("part", part) for part in parts]
    several = layers or volumes
    noisy = noise_of(files.each("center")[0], layer)
    commands = [
        [tools.tool(folder, "ldi-warp"), *files.views_of(part), "-o",
         made if several else ldi, *(["--layer", layer] if layer else []),
         *(["--noisy", noisy] if noisy else [])]
        for part, made in zip(parts, apart)]
    if several:
        commands.append([tools.tool(folder, "ldi-cluster"), *apart, *volumes,
                         "-o", ldi])
    return commands


def gather_command(folder, ldi, out, options):
    """A picture of the scene's size, because Blender has no pixels beyond
    it."""
    return [tools.tool(folder, "dof-gather"), ldi, "-o", out,
            "--overscan", "crop", *options]


def finish_command(folder, files, out, rectangles=0, options=()):
    """Makes dof-finish improve the gathered picture with the two renders, and
    those of rectangles."""
    names = ["rays_%d"] + ["rays_%%d_%d" % (number + 1)
                           for number in range(rectangles)]
    return [tools.tool(folder, "dof-finish"), files.path("gathered"),
            *[files.path(name % half) for name in names for half in (1, 2)],
            "-o", out, *options]


DRAFT_WIDTH = 640  # pixels to gather; a wider picture is first shown smaller


def draft_options(width, supersample):
    """A picture that is made smaller is gathered without sub-pixels, three
    times as fast as with them at half the size."""
    least = 1 if supersample == 1 else 2
    return ["--quality", "draft",
            "--proxy", str(max(least, math.ceil(width / DRAFT_WIDTH)))]
