"""Depth of field from a few pinhole renders: numpy in, numpy out.

    views = [sparselens.open_view(name) for name in names]  # the centre view first
    ldi = sparselens.cluster(sparselens.warp(views))
    picture = sparselens.gather(ldi, focus_distance=3.4)
    picture.pixels                                          # float32 (height, width, channels)
    sparselens.write("focus-at-3.4.exr", picture)

Keyword arguments have the names of the tools' options. Pixels are scene-linear, premultiplied by A, in the pixel
geometry of OpenEXR: windows are (left, top, right, bottom), the last ones included, y down. Depth z is planar, in scene
units, above 0, inf where nothing was hit. A lens value that no argument gives is taken from the file.

Every function that takes long releases the interpreter's lock and ends on Ctrl-C. progress is called with the name of
the stage and a whole percentage; if it raises, the work ends and the exception is passed on."""
import os
from typing import Any, Callable, Literal, Mapping, Optional, Sequence, TypedDict, Union, overload

import numpy
import numpy.typing

__version__: str

_Path = Union[str, os.PathLike[str]]
_Floats = numpy.typing.NDArray[numpy.float32]
_Ids = numpy.typing.NDArray[numpy.uint32]
_Offsets = numpy.typing.NDArray[numpy.uint64]
_Mask = numpy.typing.NDArray[numpy.bool_]
_Pair = tuple[float, float]
_Box = tuple[int, int, int, int]
_Matrix = Union[Sequence[Sequence[float]], numpy.typing.NDArray[numpy.floating[Any]]]
_Layout = Literal["hwc", "chw"]
_Depth = Literal["z", "distance", "inverse", "negative", "normalized", "hyperbolic"]
_Progress = Callable[[str, int], object]

class Error(RuntimeError):
    """A failure of input, output or memory; the message names the file, channel or argument."""
class UsageError(ValueError):
    """An argument has an invalid value, or a required value is missing; the message names the argument."""
def LENS(
    focal_length: Optional[float] = None,  # mm
    sensor_width: Optional[float] = None,  # mm, spans the display window
    fstop: Optional[float] = None,  # a number, or inf
    lens_radius: Optional[float] = None,  # scene units, instead of fstop
    focus_distance: Optional[float] = None,  # scene units, or inf
    scene_unit: Optional[float] = None,  # metres
): ...
def WINDOWS(
    data_window, display_window: Optional[_Box] = None,
    pixel_aspect: float = 1,
): ...
def DEPTH(
    depth: _Depth = "z",  # what depth channels hold: "z" planar, "distance" along the ray, "inverse" 1 / z, "negative" -z,
    # "normalized" 0 at near to 1 at far (near is the larger if white is near), "hyperbolic" the same, linear in 1 / z.
    # Depths beyond far (default: 1e10) are sky.
    near, far: Optional[float] = None,
    disparity: bool = False,  # the depth is a disparity, white near, as programs estimate it from a photograph; instead of depth.
): ...
def PICTURE(
    stereo_view: Optional[str] = None,  # the view of a stereo file, such as "right".
    layer: Optional[str] = None,  # which picture to take from a file that holds several, such as a view layer of Blender.
    unpremultiplied: bool = False,  # the colours of the file are not yet multiplied by A.
    data, light: Optional[str] = None,  # layers or channels of that kind, separated by commas (default: by their names).
): ...
def FILE(
    **DEPTH,
    depth_channel: Optional[str] = None,  # default: Z, depth.Z, *.Depth.Z or the like, in any case.
    depth_file: Optional[_Path] = None,  # a flat EXR of the same size that holds the depth, or a grey PNG, JPEG or TIFF, which
    # is a disparity; the picture then needs no depth.
    **PICTURE,
): ...
def DEVICE(
    device: Optional[str] = "cpu",  # the device that works: "cpu", "auto" (a GPU if there is one), "gpu" (a GPU, or Error), or
    # a part of a device's name, which may be a device in software.
): ...
def SUPERSAMPLE(
    supersample: Optional[int] = None,  # this many pixels of what is given, across and down, become one pixel of the picture
    # (default: as it says, else 1).
): ...
def PROGRESS(
    progress: Optional[_Progress] = None,  # called with the name of the stage and a whole percentage.
): ...

class Camera:
    """The camera and its lens, as a file or the arguments state them. An unknown value is None."""

    focal_length: Optional[float]  # Millimetres.
    sensor_width: Optional[float]  # Millimetres; it spans the display window.
    fstop: Optional[float]  # The f-number, or inf.
    lens_radius: Optional[float]  # Radius of the aperture, scene units.
    focus_distance: Optional[float]  # Scene units, or inf.
    scene_unit: Optional[float]  # Length of a scene unit, metres.
    world_to_camera: Optional[list[list[float]]]  # 4 rows of 4 numbers that act on row vectors, as in OpenEXR. Camera
    # space: x right, y up, z forward.
    supersample: Optional[int]  # For an LDI and its views: this many pixels, across and down, become one pixel of the picture.
    lens_points: list[_Pair]  # For an LDI: the positions of its views, (x, y) in scene units, x right, y up.

class _Windows:
    width: int  # Pixels across the data window.
    height: int  # Pixels down the data window.
    data_window: _Box  # The pixels that are stored: (left, top, right, bottom), the last ones included, y down.
    display_window: _Box  # The camera's frame, in the same form as data_window.
    pixel_aspect: float  # Width over height of a pixel.
    channels: tuple[str, ...]  # The names of the channels, in the order of their planes.

class _Image(_Windows):
    planes: _Floats  # float32 (channels, height, width). No copy: it looks into the memory of this object.
    pixels: _Floats  # float32 (height, width, channels). No copy: the same memory as planes, with other strides.
    def __getitem__(self, channel: str) -> Any:
        """The channel of that name: float32 (height, width), or uint32 for ids. No copy. Raises KeyError."""

class _Opened:
    name: str  # The name of the file, or the given name. Messages use it.
    camera: Camera  # What is known about the camera and the lens.
    notes: list[str]  # Notes on how the contents of the file were interpreted.

class View(_Image, _Opened):
    """A rendered picture with depth. Its arrays are read-only.

    Raises TypeError and UsageError (a ValueError), which name the argument, and Error if most depths are invalid."""

    def __init__(
        self,
        image: _Floats,  # float32 (height, width, channels), as OpenImageIO's ImageBuf.get_pixels() gives it, or (channels,
        # height, width) with layout="chw"; any strides. It is copied once.
        z: Optional[_Floats] = None, *,  # float32 (height, width), with the meaning that depth= gives. Without it, one of the
        # channels is the depth.
        channels: Optional[Sequence[str]] = None,  # their names (default: R, G, B and, if there are four, A).
        layout: _Layout = "hwc",  # "hwc" or "chw".
        position: Optional[_Pair] = None,  # (x, y), where the camera stood relative to the centre view: scene units, x right,
        # y up.
        world_to_camera: Optional[_Matrix] = None,  # 4 x 4 numbers, instead of position; see Camera.
        name: Optional[str] = None,  # for messages (default: "view").
        **WINDOWS,  # default: (0, 0, width - 1, height - 1) for both, and 1.
        **DEPTH,  # what depths mean, as in open_view.
        depth_channel: Optional[str] = None,  # as in open_view.
        unpremultiplied: bool = False,  # as in open_view.
        **LENS,  # Lens values:
    ) -> None: ...
    z: _Floats  # Planar depth: float32 (height, width), scene units, inf where nothing was hit. No copy.
    position: Optional[_Pair]  # The position of the camera as it was given: (x, y), scene units, x right, y up; or None.

class Ldi(_Windows, _Opened):
    """A layered depth image: any number of samples in each pixel, sorted by depth. Its arrays are read-only.

    Pixel i, counted row by row, has the samples begin[i] to begin[i + 1] - 1 of every array. Samples are sorted, and
    overlaps resolved. Raises TypeError and UsageError (a ValueError), which name the argument."""

    def __init__(
        self,
        begin: _Offsets,  # uint64 (height * width + 1), from 0 to the number of samples, not descending.
        z: _Floats,  # float32 (samples), depth of the front of each sample.
        channels: Mapping[str, Union[_Floats, _Ids]], *,  # a dict of names and arrays, float32 (samples), or uint32 for ids.
        # Without A all samples are opaque.
        size: tuple[int, int],  # (width, height).
        z_back, dx, dy, weight, optical, solid: Optional[_Floats] = None,  # float32 (samples), see the properties; dx and dy
        # come together.
        name: Optional[str] = None,  # for messages (default: "ldi").
        **WINDOWS,  # as in View.
        world_to_camera: Optional[_Matrix] = None,  # as in View.
        **DEPTH,  # what z means, as in open_view.
        unpremultiplied: bool = False,  # as in open_view.
        **LENS,  # Lens values:
    ) -> None: ...
    begin: _Offsets  # uint64 (height * width + 1): where the samples of each pixel begin. No copy.
    z: _Floats  # float32 (samples): depth of the front of each sample, scene units. No copy.
    z_back: Optional[_Floats]  # float32 (samples): depth of the back, at least z; None if all samples are points. No copy.
    dx: Optional[_Floats]  # float32 (samples): offset from the pixel centre, -1/2 to 1/2, x right; None if all are 0. No copy.
    dy: Optional[_Floats]  # float32 (samples): offset from the pixel centre, -1/2 to 1/2, y down; None if all are 0. No copy.
    weight: Optional[_Floats]  # float32 (samples): the number of view samples merged into each; None if all are 1. No copy.
    optical: Optional[_Floats]  # float32 (samples): depth of the image that a mirror or glass shows there; None if
    # all equal z. No copy.
    solid: Optional[_Floats]  # float32 (samples): by how much 1/z falls through the solid behind each; None if all are 0. No copy.
    samples: int  # The number of samples.
    def __getitem__(self, channel: str) -> Any:
        """The channel of that name: float32 (samples), or uint32 for ids. No copy. Raises KeyError."""

class Picture(_Image):
    """A flat picture. Its arrays can be written to.

    Raises TypeError and UsageError (a ValueError), which name the argument."""

    def __init__(
        self,
        image: _Floats, *,  # float32 (height, width, channels), (height, width), or (channels, height, width) with layout="chw".
        # It is copied once.
        channels: Optional[Sequence[str]] = None,  # their names, as in View.
        layout: _Layout = "hwc",  # "hwc" or "chw".
        **WINDOWS,  # as in View.
    ) -> None: ...
    camera: Camera  # The camera and the lens that made it, with the focus distance that focus_pixel found.
    def _repr_png_(self) -> Optional[bytes]:
        """The picture as PNG, through the default display and view; None without R, G and B. Notebooks call it."""

class PlannedView:
    """A view that is worth rendering."""

    lens_point: _Pair  # Where it stands in the unit disc of the lens: (x, y), x right, y up.
    position: _Pair  # Where its camera stands relative to the centre view: (x, y), scene units, x right, y up.
    share: float  # What is to be rendered, as a share of one full view.
    uncovered: int  # The number of pixels that something nearer hides from the centre view, without the margin.
    mask: _Mask  # bool (height, width): the pixels to render. No copy.
    rectangles: list[_Box]  # A few rectangles that contain the mask: (left, top, right, bottom), the last ones included.

class Plan:
    """What is worth rendering in addition to the centre view."""

    views: list[PlannedView]  # The views; empty if the centre view is enough.
    share: float  # What is to be rendered, as a share of one full view.
    full_views: bool  # Whether noise is the larger error, so that whole views pay as further samples.
    supersample: int  # How many times larger to render the views with as many rays: 2 if depth has many edges, else 1.
    rays: Optional[dict[str, float]]  # How plan() divided its rays: views, how many; supersample, times the size at
    # which to render them; samples, of each of their pixels; per_render, rays of each of two renders through the
    # lens, 0 if views take all; noise_db, the noise of all rays in one render through the lens; alone, whether that
    # is better, and needs no views.
    moments: Optional[int]  # How many moments of a shutter the picture needs; None if plan() got one view, or nothing has texture.
    motion: Optional[float]  # How far things move while the shutter is open, pixels of the picture; None as for moments.
    noise_db: float  # The noise left in the lens picture of the centre view alone, dB, tone-mapped; inf if there is none.
    overscan: _Box  # Pixels beyond the borders from which the lens brings light inside: (left, top, right, bottom).

class _Nonfinite(TypedDict):
    image, reference: int

class _Figures(TypedDict):
    psnr, psnr_tonemapped, psnr_srgb, psnr_worst, relmse, smape, ssim, ssim_srgb, p99, max, max_alpha: float
    pixels: int
    nonfinite: _Nonfinite

class _Comparison(_Figures, total=False):
    regions: dict[str, _Figures]

class _Finished(TypedDict):
    picture, trust, error: Picture
    psnr: Optional[float]
    mse, mse_deviation: float

class _Matched(TypedDict):
    value: float
    interval: _Pair

class _MatchedLens(TypedDict):
    focus_distance, lens_radius: _Matched
    fstop: Optional[_Matched]
    softness, matched_share, largest_coc: float
    doubt: str
    fit: Picture

def open_view(
    path: _Path, *,
    position: Optional[_Pair] = None,  # (x, y), where the camera stood relative to the centre view, scene units; default: as
    # the file says.
    center: Optional[View] = None,  # the centre view, which supplies what this file does not say about its frustum.
    **FILE,
    **LENS,  # Lens values replace those of the file:
) -> View:
    """Opens a rendered view, a flat EXR with depth, and returns a View. Invalid values are repaired, with a warning.

    Raises Error if the file cannot be read, and UsageError if a value is missing."""

def open_ldi(
    path: _Path, *,
    **FILE,  # as in open_view.
    **LENS,  # Lens values replace those of the file:
) -> Ldi:
    """Opens any deep EXR, or a flat one with depth, and returns an Ldi. Errors are as in open_view."""

def open_picture(
    path: _Path, *,
    **PICTURE,  # as in open_view.
) -> Picture:
    """Opens a flat EXR and returns a Picture of all its channels. Raises Error if the file cannot be read."""

def warp(
    views: Union[View, Ldi, Sequence[Union[View, Ldi]]], *,  # a sequence of View, the centre view first. Each stands where its
    # position or its camera says. A deep view is an Ldi from open_ldi(), which stands where its camera says. An Ldi that is
    # already warped is refused (UsageError).
    denoised: Optional[Union[Picture, Sequence[Picture]]] = None,  # each view after a denoiser. Its colours are used, except for
    # details that all views show.
    noisy: Optional[str] = None,  # the same for views that are already denoised, and hold their noisy picture in this layer
    # (Cycles: "Noisy Image").
    merge: Literal["average", "keep"] = "average",  # "average" the views of a surface, or "keep" one sample per surface and the
    # centre view unchanged.
    silhouettes: Literal["split", "whole"] = "split",  # "split" pixels that mix two surfaces into two samples, or leave them
    # "whole".
    agreement: Literal["test", "assume"] = "test",  # "test" whether views agree out of focus before they are averaged, or
    # "assume" it.
    optical: Literal["on", "off"] = "on",  # "on" finds the depth of what mirrors and glass show, by which it is blurred and
    # averaged; or "off".
    **DEVICE,
    **SUPERSAMPLE,
    **PROGRESS,
    **LENS,  # Lens values replace those of the centre view:
) -> Ldi:
    """Warps views into one layered depth image and returns an Ldi. Does what ldi-warp does.

    Raises UsageError if the position of a view or the focal length is unknown, and Error if views do not match."""

def cluster(
    ldi: Union[Ldi, Sequence[Ldi]], *,  # an Ldi, or a sequence of them, which are merged by depth first.
    tolerance: Optional[float] = 0.25,  # pixels. Samples whose circles of confusion differ by less are merged.
    layers: int = 0,  # the largest number of samples per pixel; 0: no limit.
    **SUPERSAMPLE,
    recolor: Optional[Picture] = None,  # a flat Picture of the same frame. The samples get its colours and light instead of
    # their own.
    **PROGRESS,
    **LENS,  # Lens values replace those of the LDI:
) -> Ldi:
    """Merges samples that no lens tells apart and returns an Ldi. Does what ldi-cluster does.

    Raises UsageError if the lens is unknown, and Error if several LDIs do not have one camera."""

def gather(
    ldi: Union[Ldi, Sequence[Ldi]], *,  # an Ldi, or a sequence of the moments of a shutter, by their time, which become one
    # picture with motion blur.
    channels: Optional[Union[str, Sequence[str]]] = None,  # names of channels, layers or Cryptomattes, or "rgba", as a sequence
    # or separated by commas; default: all.
    method: Literal["lens", "selective"] = "lens",  # "lens" or "selective".
    quality: Optional[Literal["draft", "normal", "final"]] = None,  # "draft", "normal" or "final" (default: "normal"; of a
    # photograph: "final"); for the method lens.
    lens_samples: Optional[int] = 0,  # points of the lens in every tile, 0: as many as the quality needs; for the method lens.
    layer_tolerance: Optional[float] = 0.25,  # pixels. Layers of a pixel whose circles of confusion differ by less are merged
    # first; 0: none; for the method lens.
    grain: Optional[float] = 1,  # noise for what is blurred in a photograph, as a factor of the noise that blur took away; for the
    # method lens.
    layers: Optional[int] = 8,  # the number of layers kept apart in a pixel; for the method selective.
    focus_pixel: Optional[tuple[int, int]] = None,  # (x, y), focuses on the front surface in this pixel of the picture, instead
    # of focus_distance (default, of a photograph: on the nearest large thing near its middle).
    blur: Optional[Union[float, str]] = "2%",  # pixels or, as a str, a share of the picture's width, for a photograph, in place of
    # a lens: the radius of the disc that a white pixel of the depth becomes when black is in focus.
    holdout: Optional[Ldi] = None,  # an Ldi that hides what is behind it and is not shown itself; it stays sharp unless
    # holdout_defocused.
    holdout_defocused: bool = False,
    **DEVICE,
    shutter_curve: Optional[_Path] = None,  # how the moments of a shutter count: "box", "triangle", "gaussian", or a file whose
    # lines are a time, from 0 to 1, and a value.
    rolling_shutter: Optional[float] = 1,  # the part of the shutter's time for which each row is exposed, the top row first, the
    # bottom row last; from 0.001 to 1, which exposes all rows for all of the time.
    overscan: Literal["grow", "keep", "crop"] = "grow",  # "grow" the picture as far as the blur reaches, "keep" the pixels of the
    # LDI, "crop" to the display window.
    proxy: int = 1,  # makes a picture of 1 / proxy the size.
    **SUPERSAMPLE,
    pixel_filter: Optional[str] = None,  # the pixel filter of the picture, "box", "blackman-harris" or "gaussian", the latter two
    # with ":WIDTH" if wanted (default: as the file says, else "box").
    region: Optional[_Box] = None,  # (left, top, right, bottom), makes only these pixels of the picture.
    highlight_gain: Optional[float] = 1,  # makes lights above highlight_threshold (scene-linear luminance) up to this many times
    # as bright, 1 to 1000, over a knee of highlight_knee.
    highlight_threshold, highlight_knee: Optional[float] = 1,
    **LOOKS,  # Looks of the lens, of the method lens; docs/looks.md says what they do:
    cat_eye_darkening: bool = False,  # it is dark where the cat's eye blocks light.
    axial_chromatic_type: Optional[Literal["red-blue", "blue-yellow", "green-magenta"]] = "red-blue",  # "red-blue",
    # "blue-yellow" or "green-magenta".
    tilt: Optional[_Pair] = None,  # (x, y), degrees.
    lens: Optional[_Path] = None,  # a file of share/lenses; the other keywords replace its values.
    aperture: Optional[_Path] = None,  # a picture, instead of blades.
    **PROGRESS,
    **LENS,  # Lens values replace those of the LDI:
) -> Picture:
    """Makes the picture that a lens takes of an LDI and returns a Picture. Does what dof-gather does.

    Raises UsageError if the lens is unknown, or if keywords contradict each other."""

def finish(
    gathered: Picture,  # the Picture of gather().
    rays: Sequence[Picture], *,  # a sequence of Picture.
    samples: Optional[Sequence[float]] = None,  # rays per pixel of each (default: as their files say, else the same for all).
    denoised: Optional[Sequence[Picture]] = None,  # each of rays after a denoiser, denoised by itself.
    around: Optional[Sequence[tuple[Picture, Sequence[Picture]]]] = None,  # the frames before and after: the gathered picture and
    # the renders of each.
    **PROGRESS,
) -> _Finished:
    """Corrects a gathered picture by two or more renders of a few rays through the same lens, each with a seed of its
    own. Does what dof-finish does. Returns a dict: picture; psnr, the estimated error in dB, None if it is too small to
    tell; mse and mse_deviation, the error as a mean square of tone-mapped values, and its standard deviation; trust, a
    Picture of Y: 1 where the pixel is as gathered, 0 where it is as the rays say; error, a Picture of Y: the error of
    each pixel.

    Raises UsageError if there is only one render, and Error if the sizes differ or there are no R, G and B."""

def MATCH(
    region: Optional[_Box] = None,  # (left, top, right, bottom), compares only these pixels.
    fit: Literal["both", "focus", "fstop"] = "both",  # what to find; the other value is that of the Ldi or of a keyword.
    **PROGRESS,
    **LENS,  # Lens values replace those of the LDI:
): ...
@overload
def match(
    ldi: Union[Ldi, Sequence[Ldi]],
    plate: Sequence[Picture], *,
    **MATCH,
) -> list[_MatchedLens]: ...
@overload
def match(
    ldi: Ldi,  # an Ldi that shows what the plate shows, from the same camera; for a sequence of plates, one for all or one for
    # each.
    plate: Picture, *,  # a Picture of the same size, or a sequence of them, whose lenses are made smooth over time.
    **MATCH,
) -> _MatchedLens:
    """Finds the lens of a filmed plate, and returns a dict; of a sequence of plates, a list of dicts. Does what
    dof-match does.

    The dict has focus_distance, lens_radius and fstop (None if the focal length is unknown), each as a dict of value
    and interval, which should hold the true value in 90 % of cases; softness of the whole plate (standard deviation,
    pixels); matched_share, of the blocks that show something; largest_coc (pixels); doubt, why this plate of a sequence
    has its neighbours' values, or ""; and fit, a Picture of the gathered picture beside the plate.

    Raises Error if the plate, or most plates of a sequence, cannot be matched, and says why."""

def flatten(ldi: Ldi) -> Picture:
    """Composites the samples of an Ldi front to back and returns the Picture seen without a lens."""

def front_depth(ldi: Ldi) -> Picture:
    """Returns the planar depth of the front sample of each pixel of an Ldi, inf where there is none, as a Picture of
    the channel Z. The same as dof-gather's depth output."""

def show(
    ldi: Ldi,
    what: Literal["coc", "focus", "layers"], *,  # "coc", the circle of confusion of the front sample: white in focus, blue in
    # front, red behind; "focus", green where that sample is in focus; "layers", the number of samples per pixel.
    **LENS,  # Lens values replace those of the LDI:
) -> Picture:
    """Returns false colours that show an Ldi and a lens, as a Picture of display values. The same as dof-gather's.

    Raises UsageError if the lens is unknown; layers needs no lens."""

def plan(
    view: Union[View, Sequence[View]], *,  # the centre View, or a sequence of those of a shutter's moments, which also gives
    # Plan.moments.
    views: int = 4,  # the largest number of views.
    margin: int = 2,  # pixels added around what the centre view does not see.
    noise: Optional[float] = None,  # standard deviation of the noise of a tone-mapped pixel (default: measured).
    **SUPERSAMPLE,
    rays: Optional[int] = None,  # all rays per pixel of the picture, to divide between views and renders through the lens
    # (Plan.rays).
    **PROGRESS,
    **LENS,  # Lens values replace those of the view:
) -> Plan:
    """Plans which views from the rim of the lens, and which of their pixels, are worth rendering; returns a Plan. Does
    what ldi-plan does.

    Raises UsageError if the lens is unknown."""

def compare(
    image, reference: Union[Picture, View, _Floats],  # a Picture, a View, or float32 (height, width, 3 or 4).
    *,
    regions: Optional[Ldi] = None,  # an Ldi that tells what is in focus, blurred, or a silhouette, by its lens.
    **LENS,  # Lens values replace those of the Ldi:
) -> _Comparison:
    """Returns how far a picture is from its reference, as a dict of dof-compare's figures: psnr, psnr_tonemapped,
    psnr_srgb and psnr_worst (dB), relmse, smape, ssim, ssim_srgb, p99, max, max_alpha, pixels, nonfinite;
    with regions, also the same for each region.

    Raises Error if R, G or B is missing or the display windows differ in size."""

def write(
    path: _Path,
    what: Union[Picture, Ldi, Plan, _Floats], *,  # a Picture or a numpy array (EXR, or PNG, JPEG, TIFF and the like by the
    # extension), an Ldi (deep EXR) or a Plan (JSON).
    compression: Optional[str] = None,  # of EXR, such as "zip" (default: as in the file that it came from).
    type: Optional[Literal["half", "float"]] = None,  # "half" or "float", for the channels of a picture (default: their own type;
    # float if they came from numpy).
    tiles: int = 0,  # writes the EXR of a picture in tiles with sides of this many pixels; 0: in scanlines.
    colorconfig: Optional[_Path] = None,  # of OpenColorIO, as are display and view_transform, for PNG and the like (default:
    # $OCIO and its display).
    display, view_transform: Optional[str] = None,
    masks: Optional[_Path] = None,  # with a Plan, a folder for one mask per view.
) -> None:
    """Writes a file; an interrupted or failed write leaves no partial file.

    Raises Error if the file cannot be written, and UsageError for a keyword that does not apply."""

class Viewing:
    @property
    def address(self) -> str: ...
    def close(self) -> None: ...
    def __enter__(self) -> Viewing: ...
    def __exit__(self, *_: object) -> None: ...
    def _repr_html_(self) -> str: ...

def view(ldi: Union[Ldi, _Path], *, open: bool = False, **options: Any) -> Viewing: ...
def set_limits(*, threads: Optional[int] = None, max_memory: Optional[float] = None) -> None:
    """Sets the limits of the process. threads: 0 means all cores. max_memory: bytes that reading a file may take;
    0: 64 MB plus 1100 times the size of the file."""
