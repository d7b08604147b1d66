"""Depth of field from a few pinhole renders. See help(sparselens)."""
import os
from typing import Any, Callable, Literal, Mapping, Optional, Sequence, TypedDict, Union

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

class Error(RuntimeError): ...
class UsageError(ValueError): ...

class Camera:
    @property
    def focal_length(self) -> Optional[float]: ...
    @property
    def sensor_width(self) -> Optional[float]: ...
    @property
    def fstop(self) -> Optional[float]: ...
    @property
    def lens_radius(self) -> Optional[float]: ...
    @property
    def focus_distance(self) -> Optional[float]: ...
    @property
    def scene_unit(self) -> Optional[float]: ...
    @property
    def world_to_camera(self) -> Optional[list[list[float]]]: ...
    @property
    def supersample(self) -> Optional[int]: ...
    @property
    def lens_points(self) -> list[_Pair]: ...

class _Windows:
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def data_window(self) -> _Box: ...
    @property
    def display_window(self) -> _Box: ...
    @property
    def pixel_aspect(self) -> float: ...
    @property
    def channels(self) -> tuple[str, ...]: ...
    def __getitem__(self, channel: str) -> Any: ...

class View(_Windows):
    def __init__(
        self,
        image: _Floats,
        z: Optional[_Floats] = None,
        *,
        channels: Optional[Sequence[str]] = None,
        layout: _Layout = "hwc",
        position: Optional[_Pair] = None,
        world_to_camera: Optional[_Matrix] = None,
        name: Optional[str] = None,
        data_window: Optional[_Box] = None,
        display_window: Optional[_Box] = None,
        pixel_aspect: float = 1,
        depth: _Depth = "z",
        near: Optional[float] = None,
        far: Optional[float] = None,
        depth_channel: Optional[str] = None,
        focal_length: Optional[float] = None,
        sensor_width: Optional[float] = None,
        fstop: Optional[float] = None,
        lens_radius: Optional[float] = None,
        focus_distance: Optional[float] = None,
        scene_unit: Optional[float] = None,
    ) -> None: ...
    @property
    def planes(self) -> _Floats: ...
    @property
    def pixels(self) -> _Floats: ...
    @property
    def z(self) -> _Floats: ...
    @property
    def name(self) -> str: ...
    @property
    def position(self) -> Optional[_Pair]: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def notes(self) -> list[str]: ...

class Ldi(_Windows):
    def __init__(
        self,
        begin: _Offsets,
        z: _Floats,
        channels: Mapping[str, Union[_Floats, _Ids]],
        *,
        size: tuple[int, int],
        z_back: Optional[_Floats] = None,
        dx: Optional[_Floats] = None,
        dy: Optional[_Floats] = None,
        weight: Optional[_Floats] = None,
        optical: Optional[_Floats] = None,
        solid: Optional[_Floats] = None,
        name: Optional[str] = None,
        data_window: Optional[_Box] = None,
        display_window: Optional[_Box] = None,
        pixel_aspect: float = 1,
        world_to_camera: Optional[_Matrix] = None,
        depth: _Depth = "z",
        near: Optional[float] = None,
        far: Optional[float] = None,
        focal_length: Optional[float] = None,
        sensor_width: Optional[float] = None,
        fstop: Optional[float] = None,
        lens_radius: Optional[float] = None,
        focus_distance: Optional[float] = None,
        scene_unit: Optional[float] = None,
    ) -> None: ...
    @property
    def begin(self) -> _Offsets: ...
    @property
    def z(self) -> _Floats: ...
    @property
    def z_back(self) -> Optional[_Floats]: ...
    @property
    def dx(self) -> Optional[_Floats]: ...
    @property
    def dy(self) -> Optional[_Floats]: ...
    @property
    def weight(self) -> Optional[_Floats]: ...
    @property
    def optical(self) -> Optional[_Floats]: ...
    @property
    def solid(self) -> Optional[_Floats]: ...
    @property
    def samples(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def notes(self) -> list[str]: ...

class Picture(_Windows):
    def __init__(
        self,
        image: _Floats,
        *,
        channels: Optional[Sequence[str]] = None,
        layout: _Layout = "hwc",
        data_window: Optional[_Box] = None,
        display_window: Optional[_Box] = None,
        pixel_aspect: float = 1,
    ) -> None: ...
    @property
    def planes(self) -> _Floats: ...
    @property
    def pixels(self) -> _Floats: ...
    def _repr_png_(self) -> Optional[bytes]: ...

class PlannedView:
    @property
    def lens_point(self) -> _Pair: ...
    @property
    def position(self) -> _Pair: ...
    @property
    def share(self) -> float: ...
    @property
    def uncovered(self) -> int: ...
    @property
    def mask(self) -> _Mask: ...
    @property
    def rectangles(self) -> list[_Box]: ...

class Plan:
    @property
    def views(self) -> list[PlannedView]: ...
    @property
    def share(self) -> float: ...
    @property
    def full_views(self) -> bool: ...
    @property
    def noise_db(self) -> float: ...
    @property
    def overscan(self) -> _Box: ...

class _Nonfinite(TypedDict):
    image: int
    reference: int

class _Figures(TypedDict):
    psnr: float
    psnr_tonemapped: float
    psnr_worst: float
    relmse: float
    smape: float
    ssim: float
    p99: float
    max: float
    max_alpha: float
    pixels: int
    nonfinite: _Nonfinite

class _Comparison(_Figures, total=False):
    regions: dict[str, _Figures]

def open_view(
    path: _Path,
    *,
    position: Optional[_Pair] = None,
    center: Optional[View] = None,
    depth: _Depth = "z",
    near: Optional[float] = None,
    far: Optional[float] = None,
    depth_channel: Optional[str] = None,
    stereo_view: Optional[str] = None,
    layer: Optional[str] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> View: ...
def open_ldi(
    path: _Path,
    *,
    depth: _Depth = "z",
    near: Optional[float] = None,
    far: Optional[float] = None,
    depth_channel: Optional[str] = None,
    stereo_view: Optional[str] = None,
    layer: Optional[str] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> Ldi: ...
def open_picture(path: _Path, *, stereo_view: Optional[str] = None, layer: Optional[str] = None) -> Picture: ...
def warp(
    views: Union[View, Sequence[View]],
    *,
    merge: Literal["average", "keep"] = "average",
    silhouettes: Literal["split", "whole"] = "split",
    agreement: Literal["test", "assume"] = "test",
    optical: Literal["on", "off"] = "on",
    device: Optional[str] = "cpu",
    progress: Optional[_Progress] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> Ldi: ...
def cluster(
    ldi: Union[Ldi, Sequence[Ldi]],
    *,
    tolerance: Optional[float] = 0.25,
    layers: int = 0,
    progress: Optional[_Progress] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> Ldi: ...
def gather(
    ldi: Ldi,
    *,
    channels: Optional[Union[str, Sequence[str]]] = None,
    method: Literal["lens", "selective"] = "lens",
    quality: Optional[Literal["draft", "normal", "final"]] = "normal",
    lens_samples: Optional[int] = 0,
    layer_tolerance: Optional[float] = 0.25,
    layers: Optional[int] = 8,
    focus_pixel: Optional[tuple[int, int]] = None,
    holdout: Optional[Ldi] = None,
    holdout_defocused: bool = False,
    device: Optional[str] = "cpu",
    overscan: Literal["grow", "keep", "crop"] = "grow",
    proxy: int = 1,
    supersample: Optional[int] = None,
    pixel_filter: Optional[str] = None,
    region: Optional[_Box] = None,
    highlight_gain: Optional[float] = 1,
    highlight_threshold: Optional[float] = 1,
    highlight_knee: Optional[float] = 1,
    blades: Optional[float] = None,
    blade_curvature: Optional[float] = None,
    blade_rotation: Optional[float] = None,
    squeeze: Optional[float] = None,
    spherical: Optional[float] = None,
    cat_eye: Optional[float] = None,
    axial_chromatic: Optional[float] = None,
    field_curvature: Optional[float] = None,
    astigmatism: Optional[float] = None,
    breathing: Optional[float] = None,
    cat_eye_darkening: bool = False,
    axial_chromatic_type: Optional[Literal["red-blue", "blue-yellow", "green-magenta"]] = "red-blue",
    tilt: Optional[_Pair] = None,
    lens: Optional[_Path] = None,
    aperture: Optional[_Path] = None,
    progress: Optional[_Progress] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> Picture: ...
def flatten(ldi: Ldi) -> Picture: ...
def front_depth(ldi: Ldi) -> Picture: ...
def show(
    ldi: Ldi,
    what: Literal["coc", "focus", "layers"],
    *,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> Picture: ...
def plan(
    view: View,
    *,
    views: int = 4,
    margin: int = 2,
    noise: Optional[float] = None,
    progress: Optional[_Progress] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> Plan: ...
def compare(
    image: Union[Picture, View, _Floats],
    reference: Union[Picture, View, _Floats],
    *,
    regions: Optional[Ldi] = None,
    focal_length: Optional[float] = None,
    sensor_width: Optional[float] = None,
    fstop: Optional[float] = None,
    lens_radius: Optional[float] = None,
    focus_distance: Optional[float] = None,
    scene_unit: Optional[float] = None,
) -> _Comparison: ...
def write(
    path: _Path,
    what: Union[Picture, Ldi, Plan, _Floats],
    *,
    compression: Optional[str] = None,
    type: Optional[Literal["half", "float"]] = None,
    colorconfig: Optional[_Path] = None,
    display: Optional[str] = None,
    view_transform: Optional[str] = None,
    masks: Optional[_Path] = None,
) -> None: ...
class Viewing:
    @property
    def address(self) -> str: ...
    def close(self) -> None: ...
    def __enter__(self) -> Viewing: ...
    def __exit__(self, *_: object) -> None: ...
    def _repr_html_(self) -> str: ...

def view(ldi: Union[Ldi, _Path], *, open: bool = False, **options: Any) -> Viewing: ...
def set_limits(*, threads: Optional[int] = None, max_memory: Optional[float] = None) -> None: ...
