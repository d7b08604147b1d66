// The texts of help(). A function's begins with its signature, which Python's inspect module understands in this form.
#pragma once

namespace sparselens::python::doc {

inline constexpr const char *module = R"(Depth of field from a few pinhole renders: numpy in, numpy out.

    views = [sparselens.open_view(name) for name in names]  # the centre view first
    ldi = sparselens.cluster(sparselens.warp(views))
    picture = sparselens.gather(ldi, focus_distance=3.4)
    picture.pixels                                          # float32 (height, width, channels)
    sparselens.write("focus-at-3.4.exr", picture)

Keyword arguments are named as the options of the tools. Pixels are scene-linear, premultiplied by A, in the pixel
geometry of OpenEXR: windows are (left, top, right, bottom), the last ones included, y down. Depth z is planar, in scene
units, above 0, inf where nothing was hit. A value of the lens that no argument gives is taken from the file.

Every function that takes long releases the interpreter's lock and ends on Ctrl-C. progress is called with the name of the
stage and a whole percentage; where it raises, the work ends and the exception is passed on.)";

inline constexpr const char *error =
    R"(A failure of input, output or memory; the message names the file, channel or argument.)";
inline constexpr const char *usage_error =
    R"(An argument has a value that it cannot have, or a value that is needed is missing; the message names the argument.)";
inline constexpr const char *width = "Pixels across the data window.";
inline constexpr const char *height = "Pixels down the data window.";
inline constexpr const char *data_window =
    R"(The pixels that are stored: (left, top, right, bottom), the last ones included, y down.)";
inline constexpr const char *display_window = "The frame of the camera, as data_window is written.";
inline constexpr const char *pixel_aspect = "Width over height of a pixel.";
inline constexpr const char *channels = "The names of the channels, in the order of their planes.";
inline constexpr const char *planes =
    "float32 (channels, height, width). No copy: it looks into the memory of this object.";
inline constexpr const char *pixels =
    R"(float32 (height, width, channels). No copy: the same memory as planes, with other strides.)";
inline constexpr const char *plane =
    R"(The channel of that name: float32 (height, width), or uint32 for ids. No copy. Raises KeyError.)";
inline constexpr const char *camera =
    R"(What a file or the arguments say of the camera and its lens. A value that is unknown is None.)";
inline constexpr const char *focal_length = "Millimetres.";
inline constexpr const char *sensor_width = "Millimetres; it spans the display window.";
inline constexpr const char *fstop = "The f-number, or inf.";
inline constexpr const char *lens_radius = "Radius of the aperture, scene units.";
inline constexpr const char *focus_distance = "Scene units, or inf.";
inline constexpr const char *scene_unit = "Length of a scene unit, metres.";
inline constexpr const char *world_to_camera =
    R"(4 rows of 4 numbers that act on row vectors, as in OpenEXR. Camera space: x right, y up, z forward.)";
inline constexpr const char *supersample =
    "Of an LDI and its views: so many pixels, across and down, are one of the picture.";
inline constexpr const char *lens_points =
    "Of an LDI: where its views stood, (x, y) in scene units, x right, y up.";
inline constexpr const char *view = R"(View(image, z=None, **keywords)
--

A rendered picture with depth. Its arrays are read-only.

image: float32 (height, width, channels), as OpenImageIO's ImageBuf.get_pixels() gives it, or (channels, height, width)
  with layout="chw"; any strides. It is copied once.
z: float32 (height, width), in the meaning that depth= says. Without it, the depth is one of the channels.

Keywords:
  channels: the names of the channels (default: R, G, B and, if there are four, A)
  layout: "hwc" (default) or "chw"
  position: (x, y), where the camera stood relative to the centre view: scene units, x right, y up
  world_to_camera: 4 x 4 numbers, instead of position; see Camera
  name: for messages (default: "view")
  data_window, display_window, pixel_aspect (default: (0, 0, width - 1, height - 1) for both, and 1)
  depth, near, far, depth_channel: what the depths are, as in open_view
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises TypeError and UsageError (a ValueError), which name the argument, and Error where most depths are invalid.)";

inline constexpr const char *view_init = "See help(sparselens.View).";
inline constexpr const char *view_z =
    R"(Planar depth: float32 (height, width), scene units, inf where nothing was hit. No copy.)";
inline constexpr const char *name = "The name of the file, or the one given: for messages.";
inline constexpr const char *position =
    R"(Where the camera stood, as it was given: (x, y), scene units, x right, y up; or None.)";
inline constexpr const char *camera_of = "What is known of the camera and the lens.";
inline constexpr const char *notes = "What was taken for what in the file.";
inline constexpr const char *ldi = R"(Ldi(begin, z, channels, *, size, **keywords)
--

A layered depth image: any number of samples in each pixel, sorted by depth. Its arrays are read-only.

Pixel i, counted row by row, has the samples begin[i] to begin[i + 1] - 1 of every array.

begin: uint64 (height * width + 1), from 0 to the number of samples, not descending.
z: float32 (samples), depth of the front of each sample.
channels: a dict of names and arrays, float32 (samples), or uint32 for ids. Without A all samples are opaque.

Keywords:
  size: (width, height)
  z_back, dx, dy, weight, optical, solid: float32 (samples), see the properties; dx and dy come together
  name: for messages (default: "ldi")
  data_window, display_window, pixel_aspect, world_to_camera: as in View
  depth, near, far: what z is, as in open_view
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Samples are sorted, and overlaps resolved. Raises TypeError and UsageError (a ValueError), which name the argument.)";

inline constexpr const char *ldi_init = "See help(sparselens.Ldi).";
inline constexpr const char *begin =
    "uint64 (height * width + 1): where the samples of each pixel begin. No copy.";
inline constexpr const char *ldi_z =
    "float32 (samples): depth of the front of each sample, scene units. No copy.";
inline constexpr const char *z_back =
    R"(float32 (samples): depth of the back, at least z; None where all samples are points. No copy.)";
inline constexpr const char *dx =
    R"(float32 (samples): offset from the pixel centre, -1/2 to 1/2, x right; None where all are 0. No copy.)";
inline constexpr const char *dy =
    R"(float32 (samples): offset from the pixel centre, -1/2 to 1/2, y down; None where all are 0. No copy.)";
inline constexpr const char *weight =
    R"(float32 (samples): the number of view samples merged into each; None where all are 1. No copy.)";
inline constexpr const char *optical =
    R"(float32 (samples): depth of the image that a mirror or glass shows there; None where all are as z. No copy.)";
inline constexpr const char *solid =
    R"(float32 (samples): by how much 1/z falls through what is solid behind each; None where all are 0. No copy.)";
inline constexpr const char *samples_of =
    R"(The channel of that name: float32 (samples), or uint32 for ids. No copy. Raises KeyError.)";
inline constexpr const char *samples = "The number of samples.";
inline constexpr const char *picture =
    R"(Picture(image, *, channels=None, layout='hwc', data_window=None, display_window=None, pixel_aspect=1)
--

A flat picture. Its arrays can be written to.

image: float32 (height, width, channels), (height, width), or (channels, height, width) with layout="chw". It is
copied once. Raises TypeError and UsageError (a ValueError), which name the argument.)";

inline constexpr const char *repr_png =
    "The picture as PNG, through the default display and view; None without R, G and B. Notebooks call it.";
inline constexpr const char *picture_init = "See help(sparselens.Picture).";
inline constexpr const char *planned_view = "A view that is worth rendering.";
inline constexpr const char *lens_point =
    "Where it stands in the unit disc of the lens: (x, y), x right, y up.";
inline constexpr const char *planned_position =
    R"(Where its camera stands relative to the centre view: (x, y), scene units, x right, y up.)";
inline constexpr const char *share = "What is to be rendered, as a share of one full view.";
inline constexpr const char *uncovered =
    R"(The number of pixels that something nearer hides from the centre view, without the margin.)";
inline constexpr const char *mask = "bool (height, width): the pixels to render. No copy.";
inline constexpr const char *rectangles =
    R"(A few rectangles that contain the mask: (left, top, right, bottom), the last ones included.)";
inline constexpr const char *plan_object = "What is worth rendering in addition to the centre view.";
inline constexpr const char *planned_views =
    "The views, of which there are none where the centre view is enough.";
inline constexpr const char *full_views =
    "Whether noise is the larger error, so that whole views pay as further samples.";
inline constexpr const char *noise_db =
    R"(The noise left in the lens picture of the centre view alone, dB, tone-mapped; inf where there is none.)";
inline constexpr const char *overscan =
    R"(Pixels beyond the borders from which the lens brings light inside: (left, top, right, bottom).)";
inline constexpr const char *open_view =
    R"(open_view(path, *, position=None, center=None, depth='z', near=None, far=None, depth_channel=None, stereo_view=None, layer=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

Opens a rendered view, a flat EXR with depth, and returns a View. Invalid values are repaired, with a warning.

position: (x, y), where the camera stood relative to the centre view, scene units; default: as the file says.
center: the centre view, which gives what this file does not say of its frustum.
depth: what depth channels hold: "z" planar, "distance" along the ray, "inverse" 1 / z, "negative" -z,
  "normalized" 0 at near to 1 at far, "hyperbolic" the same, linear in 1 / z. Depths beyond far (default: 1e10) are sky.
depth_channel: default: the first of Z, depth.Z and *.Depth.Z.
stereo_view: the view of a stereo file, such as "right".
layer: the picture of a file that holds several, such as a view layer of Blender.
Lens values replace those of the file:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises Error where the file cannot be read, and UsageError where a value is missing.)";

inline constexpr const char *open_ldi =
    R"(open_ldi(path, *, depth='z', near=None, far=None, depth_channel=None, stereo_view=None, layer=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

Opens any deep EXR, or a flat one with depth, and returns an Ldi. Keywords and errors are those of open_view.)";

inline constexpr const char *open_picture = R"(open_picture(path, *, stereo_view=None, layer=None)
--

Opens a flat EXR and returns a Picture of all its channels. Raises Error where the file cannot be read.)";

inline constexpr const char *warp =
    R"(warp(views, *, merge='average', silhouettes='split', agreement='test', optical='on', device='cpu', progress=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

Warps views into one layered depth image and returns an Ldi. As ldi-warp.

views: a sequence of View, the centre view first. Each stands where its position or its camera says.
merge: "average" the views of a surface, or "keep" one sample per surface and the centre view unchanged.
silhouettes: "split" pixels that mix two surfaces into two samples, or leave them "whole".
agreement: "test" whether views agree out of focus before they are averaged, or "assume" it.
optical: "on" finds the depth of what mirrors and glass show, which then is blurred and averaged by it, or "off".
device: what warps: "cpu", "auto" (a GPU if there is one), "gpu" (a GPU, or Error), or a part of a device's name.
progress: called with the name of the stage and a whole percentage.
Lens values replace those of the centre view:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises UsageError where the position of a view or the focal length is unknown, and Error where views do not match.)";

inline constexpr const char *cluster =
    R"(cluster(ldi, *, tolerance=0.25, layers=0, progress=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

Merges samples that no lens tells apart and returns an Ldi. As ldi-cluster.

ldi: an Ldi, or a sequence of them, which are merged by depth first.
tolerance: samples are merged whose circles of confusion differ by less, pixels.
layers: at most so many samples per pixel; 0: no limit.
progress: called with the name of the stage and a whole percentage.
Lens values replace those of the LDI:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises UsageError where the lens is unknown, and Error where several LDIs are not of one camera.)";

inline constexpr const char *gather =
    R"(gather(ldi, *, channels=None, method='lens', quality='normal', lens_samples=0, layer_tolerance=0.25, layers=8, focus_pixel=None, holdout=None, holdout_defocused=False, device='cpu', overscan='grow', proxy=1, supersample=None, pixel_filter=None, region=None, highlight_gain=1, highlight_threshold=1, highlight_knee=1, blades=None, blade_curvature=None, blade_rotation=None, squeeze=None, spherical=None, cat_eye=None, axial_chromatic=None, field_curvature=None, astigmatism=None, breathing=None, cat_eye_darkening=False, axial_chromatic_type='red-blue', tilt=None, lens=None, aperture=None, progress=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

Makes the picture that a lens takes of an LDI and returns a Picture. As dof-gather.

channels: names of channels, layers or Cryptomattes, or "rgba", as a sequence or separated by commas; default: all.
method: "lens" or "selective".
quality: "draft", "normal" or "final"; lens_samples: points of the lens in every tile, 0: as many as the quality needs.
layer_tolerance: layers of a pixel whose circles of confusion differ by less are merged first, pixels; 0: none.
  Both belong to the method lens; layers, the layers kept apart in a pixel, belongs to selective.
focus_pixel: (x, y), focuses on the front surface in this pixel, instead of focus_distance.
holdout: an Ldi that hides what is behind it and is not shown itself; it stays sharp unless holdout_defocused.
device: what gathers, by the methods lens and selective: "cpu", "auto" (a GPU if there is one), "gpu" (a GPU, or Error),
  or a part of a device's name, also of one in software.
overscan: "grow" the picture as far as the blur reaches, "keep" the pixels of the LDI, "crop" to the display window.
proxy: makes a picture of 1 / proxy the size. supersample: so many pixels of the LDI, across and down, are one of the
  picture (default: as its file says, else 1); pixel_filter: that of the picture, "box", "blackman-harris" or "gaussian", the
  latter two with ":WIDTH" if wanted (default: as the file says, else "box"). focus_pixel and region count its pixels. region: (left, top, right, bottom), makes only these pixels.
highlight_gain: makes lights above highlight_threshold (scene-linear luminance) up to so many times as bright, 1 to
  1000, over a knee of highlight_knee.
Looks of the lens, of the method lens: blades (a whole number), blade_curvature (0 to 1), blade_rotation (degrees),
  squeeze (0.001 to 1000), spherical (-1 to 1), cat_eye (0 to 100, with cat_eye_darkening), axial_chromatic (mm, with
  axial_chromatic_type "red-blue", "blue-yellow" or "green-magenta"), field_curvature (-1 to 1),
  astigmatism (-1 to 1), breathing (0 to 2), tilt ((x, y), degrees), lens (a file of share/lenses, which the others beat), aperture (a picture, instead of blades).
progress: called with the name of the stage and a whole percentage.
Lens values replace those of the LDI:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises UsageError where the lens is unknown, or keywords contradict each other.)";

inline constexpr const char *flatten = R"(flatten(ldi)
--

Composites the samples of an Ldi front to back and returns the Picture seen without a lens.)";

inline constexpr const char *front_depth = R"(front_depth(ldi)
--

The planar depth of the front sample of each pixel of an Ldi, inf where there is none: a Picture of the channel Z.
As dof-gather's depth output.)";

inline constexpr const char *show =
    R"(show(ldi, what, *, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

False colours of what an Ldi and a lens are, as a Picture of display values. As dof-gather shows them.

what: "coc", the circle of confusion of the front sample: white in focus, blue in front, red behind;
  "focus", green where that sample is in focus; "layers", the number of samples per pixel.
Lens values replace those of the LDI:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises UsageError where the lens is unknown; layers needs none.)";

inline constexpr const char *plan =
    R"(plan(view, *, views=4, margin=2, noise=None, progress=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

Plans which views from the rim of the lens, and which of their pixels, are worth rendering; returns a Plan. As ldi-plan.

view: the centre View. views: the largest number of views. margin: pixels added around what it does not see.
noise: standard deviation of the noise of a tone-mapped pixel (default: measured).
progress: called with the name of the stage and a whole percentage.
Lens values replace those of the view:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises UsageError where the lens is unknown.)";

inline constexpr const char *compare =
    R"(compare(image, reference, *, regions=None, focal_length=None, sensor_width=None, fstop=None, lens_radius=None, focus_distance=None, scene_unit=None)
--

How far a picture is from its reference, as a dict of the figures of dof-compare: psnr, psnr_tonemapped and psnr_worst (dB),
relmse, smape, ssim, p99, max, max_alpha, pixels, nonfinite, and with regions the same for each of regions.

image, reference: a Picture, a View, or float32 (height, width, 3 or 4).
regions: an Ldi that tells what is in focus, blurred, or a silhouette, by its lens and these values:
  focal_length (mm), sensor_width (mm, spans the display window), fstop (a number, or inf),
  lens_radius (scene units, instead of fstop), focus_distance (scene units, or inf), scene_unit (metres)

Raises Error where R, G or B is missing or the display windows differ in size.)";

inline constexpr const char *write =
    R"(write(path, what, *, compression=None, type=None, colorconfig=None, display=None, view_transform=None, masks=None)
--

Writes a file; an interrupted or failed write leaves no partial file.

what: a Picture or a numpy array (EXR, or PNG, JPEG, TIFF and the like by the extension), an Ldi (deep EXR) or a Plan (JSON).
compression: of EXR, such as "zip"; default: that of the file that it came from.
type: "half" or "float", of the channels of a picture (default: their own; float where they came from numpy).
colorconfig, display, view_transform: of OpenColorIO, for PNG and the like (default: $OCIO and its display).
masks: with a Plan, a folder for one mask per view.

Raises Error where the file cannot be written, and UsageError for a keyword that does not apply.)";

inline constexpr const char *set_limits = R"(set_limits(*, threads=None, max_memory=None)
--

Sets the limits of the process. threads: 0 stands for all cores. max_memory: bytes that reading a file may take;
0: 64 MB plus 1100 times the size of the file.)";

} // namespace sparselens::python::doc
