"""numpy arrays: their contents, the memory they share, and which arrays are refused."""
import re

import numpy
import pytest
import sparselens

LENS = {"focal_length": 50, "sensor_width": 36, "lens_radius": 0.05, "focus_distance": 3}


def floats(*shape):
    return numpy.arange(1, 1 + numpy.prod(shape), dtype=numpy.float32).reshape(shape) / 1000


def two_pixels(**changed):
    """An LDI of two pixels, with one sample and two."""
    values = {"begin": numpy.array([0, 1, 3], numpy.uint64), "z": numpy.array([2, 1, 4], numpy.float32),
              "channels": {"R": floats(3), "A": numpy.array([1, 0.5, 1], numpy.float32)}, "size": (2, 1)}
    return sparselens.Ldi(**{**values, **changed})


def test_warp_of_deep_pictures():
    deep = two_pixels()
    warped = sparselens.warp(deep)
    for name in ["begin", "z"]:
        assert numpy.array_equal(getattr(warped, name), getattr(deep, name))
    assert numpy.array_equal(warped["R"], deep["R"]) and numpy.array_equal(warped["A"], deep["A"])
    moved = two_pixels(dx=floats(3), dy=floats(3))
    with pytest.raises(sparselens.Error, match="is an LDI, whose samples come from several views"):
        sparselens.warp([deep, moved])


def test_views_of_memory(views, clustered):
    view, ldi = views[0], sparselens.open_ldi(clustered)
    picture = sparselens.gather(ldi)
    assert view.planes.shape == (4, 54, 96) and view.pixels.shape == picture.pixels.shape == (54, 96, 4)
    for arrays in [(view.planes, view.pixels), (view.z, view.z), (ldi.begin, ldi.begin), (ldi["R"], ldi["R"]),
                   (picture.planes, picture.pixels), (picture.planes[2], picture["B"])]:
        assert numpy.shares_memory(*arrays)
    for array in (view.planes, view.pixels, view.z, ldi.begin, ldi.z, ldi["R"]):
        assert not array.flags.writeable and array.base is not None
    picture["R"][:] = 0.25
    assert (picture.pixels[..., 0] == 0.25).all()


def test_array_outlives_object(views):
    ldi = sparselens.warp(views)
    z = ldi.z
    kept = z.copy()
    del ldi
    assert numpy.array_equal(z, kept)


def test_ldi_attributes(clustered):
    ldi = sparselens.open_ldi(clustered)
    assert ldi.begin.dtype == numpy.uint64 and len(ldi.begin) == ldi.width * ldi.height + 1
    assert ldi.begin[-1] == ldi.samples == len(ldi.z) == len(ldi["A"]) == len(ldi.dx) == len(ldi.weight)
    assert ldi.channels == ("R", "G", "B", "A")
    assert len(ldi.camera.lens_points) == 5 and ldi.camera.lens_points[0] == (0, 0)


def test_numpy_views_are_as_files(views, warped):
    camera = views[0].camera
    assert re.match(r"<sparselens.Camera focal_length=[0-9.]+ sensor_width=36(.0)? fstop=.* focus_distance=", repr(camera))
    lens = {name: getattr(camera, name) for name in LENS}
    placed = []
    for view, position in zip(views, camera_points(views)):
        placed.append(sparselens.View(view.pixels.copy(), view.z, position=position, **lens))
    from_numpy, from_files = sparselens.warp(placed), sparselens.warp(views)
    assert numpy.array_equal(from_numpy.begin, from_files.begin)
    assert numpy.array_equal(from_numpy.z, from_files.z)
    assert numpy.array_equal(from_numpy["G"], from_files["G"])
    assert numpy.array_equal(sparselens.gather(from_numpy).planes, sparselens.gather(from_files).planes)


def camera_points(views):
    return sparselens.warp(views).camera.lens_points


def test_world_to_camera_places_a_view(views):
    lens = {name: getattr(views[0].camera, name) for name in LENS}
    placed = [sparselens.View(v.planes, v.z, layout="chw", world_to_camera=v.camera.world_to_camera, **lens)
              for v in views]
    assert numpy.allclose(sparselens.warp(placed).camera.lens_points, camera_points(views), atol=1e-6)


def test_layouts(views):
    view, keywords = views[0], LENS
    planar = sparselens.View(view.planes, view.z, layout="chw", **keywords)
    assert numpy.array_equal(planar.planes, view.planes)
    backwards = sparselens.View(view.pixels[::-1, ::2], view.z[::-1, ::2], **keywords)  # any strides
    assert numpy.array_equal(backwards.pixels, view.pixels[::-1, ::2])


def test_openimageio_pixels(views, names):
    oiio = pytest.importorskip("OpenImageIO")
    buffer = oiio.ImageBuf(str(names[0]))
    view = sparselens.View(buffer.get_pixels(oiio.FLOAT), channels=buffer.spec().channelnames)
    assert view.channels == views[0].channels
    assert numpy.array_equal(view.planes, views[0].planes) and numpy.array_equal(view.z, views[0].z)


def test_ldi_from_numpy():
    ldi = two_pixels(dx=floats(3), dy=floats(3), weight=floats(3), z_back=numpy.array([2, 2, 4], numpy.float32))
    assert numpy.array_equal(ldi.begin, [0, 1, 3]) and numpy.array_equal(ldi.z, [2, 1, 4])
    assert numpy.array_equal(ldi["A"], [1, 0.5, 1]) and numpy.array_equal(ldi.z_back, [2, 2, 4])
    assert numpy.array_equal(ldi.dx, floats(3)) and numpy.array_equal(ldi.weight, floats(3))
    assert two_pixels().dx is None and two_pixels().weight is None
    unsorted = two_pixels(z=numpy.array([2, 4, 1], numpy.float32))
    assert numpy.array_equal(unsorted.z, [2, 1, 4]) and unsorted["A"][1] == 1
    flat = sparselens.flatten(two_pixels())
    assert numpy.allclose(flat["R"], [[0.001, 0.002 + 0.5 * 0.003]])


def test_ids_keep_their_bits():
    ids = numpy.array([7, 0xFFFFFFFF, 0x7F800001], numpy.uint32)
    ldi = two_pixels(channels={"R": floats(3), "id": ids})
    assert ldi["id"].dtype == numpy.uint32 and numpy.array_equal(ldi["id"], ids)


def test_windows():
    picture = sparselens.Picture(floats(2, 3, 3), data_window=(4, 5, 6, 6), display_window=(0, 0, 9, 9), pixel_aspect=2)
    assert (picture.width, picture.height, picture.pixel_aspect) == (3, 2, 2)
    assert picture.data_window == (4, 5, 6, 6) and picture.display_window == (0, 0, 9, 9)
    alone = sparselens.Picture(floats(2, 3, 3), data_window=(4, 5, 6, 6))
    assert alone.display_window == (4, 5, 6, 6)


def test_invalid_values_are_repaired():
    image = floats(4, 4, 3)
    image[1, 1, 0] = numpy.nan
    with pytest.warns(UserWarning, match="not finite"):
        view = sparselens.View(image, floats(4, 4) + 1)
    assert numpy.isfinite(view.planes).all()


IMAGE, Z = floats(4, 5, 4), floats(4, 5) + 1
WRONG = [
    (TypeError, "image: must be a numpy array of float32, not list", lambda: sparselens.View([[1.0]], Z)),
    (TypeError, "image: .*float32, not float64", lambda: sparselens.View(IMAGE.astype(float), Z)),
    (ValueError, r"image: .*\(2,\)", lambda: sparselens.View(floats(2), Z)),
    (ValueError, r"image: .*pixels.*\(0, 5, 4\)", lambda: sparselens.View(IMAGE[:0], Z)),
    (ValueError, r"z: .*\(4, 5\).*\(5, 4\)", lambda: sparselens.View(IMAGE, Z.T)),
    (TypeError, "z: .*float32, not int64", lambda: sparselens.View(IMAGE, Z.astype(numpy.int64))),
    (ValueError, "channels: image has 2 of them", lambda: sparselens.View(IMAGE[..., :2], Z)),
    (ValueError, "channels: there are 3 names", lambda: sparselens.View(IMAGE, Z, channels=["R", "G", "B"])),
    (ValueError, "channels: 'R' is there twice", lambda: sparselens.View(IMAGE, Z, channels=list("RRGB"))),
    (TypeError, "channels: ", lambda: sparselens.View(IMAGE, Z, channels="RGBA")),
    (sparselens.Error, "Z", lambda: sparselens.View(IMAGE)),
    (ValueError, "position: ", lambda: sparselens.View(IMAGE, Z, position=(1, 2, 3))),
    (TypeError, "position: ", lambda: sparselens.View(IMAGE, Z, position="left")),
    (TypeError, "world_to_camera: ", lambda: sparselens.View(IMAGE, Z, world_to_camera=[1, 2])),
    (ValueError, "data_window: is 1 x 1", lambda: sparselens.View(IMAGE, Z, data_window=(0, 0, 0, 0))),
    (ValueError, "display_window: is outside the range", lambda: sparselens.Picture(IMAGE, display_window=(-2**31, 0, 2**31 - 1, 0))),
    (ValueError, "data_window: is outside the range", lambda: sparselens.View(IMAGE, Z, data_window=(2**30, 0, 2**30 + 4, 3))),
    (ValueError, "pixel_aspect: must be from 1e-6", lambda: sparselens.Picture(IMAGE, pixel_aspect=1e-46)),
    (sparselens.Error, "x.png: asks for", lambda: sparselens.write("x.png", sparselens.Picture(IMAGE, display_window=(0, 0, 99999, 99999)))),
    (ValueError, "layout: must be one of hwc, chw, not cwh", lambda: sparselens.View(IMAGE, Z, layout="cwh")),
    (TypeError, "begin: .*uint64, not int64", lambda: two_pixels(begin=numpy.array([0, 1, 3]))),
    (ValueError, "begin: .*3 values, not 2", lambda: two_pixels(begin=numpy.array([0, 3], numpy.uint64))),
    (ValueError, "begin: goes from 0 to 2", lambda: two_pixels(begin=numpy.array([0, 1, 2], numpy.uint64))),
    (ValueError, "begin: entry 2", lambda: two_pixels(begin=numpy.array([0, 4, 3], numpy.uint64))),
    (ValueError, "channels: R: .*3 values, not 2", lambda: two_pixels(channels={"R": floats(2)})),
    (TypeError, "channels: must be a dict", lambda: two_pixels(channels=[floats(3)])),
    (ValueError, "dx: must be given with dy", lambda: two_pixels(dx=floats(3))),
    (ValueError, "weight: .*one dimension", lambda: two_pixels(weight=floats(3, 1))),
    (ValueError, "z_back: sample 1", lambda: two_pixels(z_back=numpy.array([2, 0.5, 4], numpy.float32))),
    (ValueError, "size: ", lambda: two_pixels(size=(0, 1))),
    (TypeError, "ldi: must be an Ldi, or a sequence of the moments of a shutter, not ndarray", lambda: sparselens.gather(Z)),
    (TypeError, r"gather\(\) has no keyword argument 'fstp'; did you mean fstop\?$", lambda: sparselens.gather(two_pixels(), fstp=2)),
    (TypeError, r"gather\(\) has no keyword argument 'nonsense'$", lambda: sparselens.gather(two_pixels(), nonsense=2)),
    (ValueError, r"^focus_pixel: 7,0 lies outside of ldi, whose pixels go from 0,0 to 1,0$", lambda: sparselens.gather(two_pixels(**LENS), focus_pixel=(7, 0))),
    (ValueError, r"^focus_pixel: ldi has no sample at \(0, 0\)", lambda: sparselens.gather(two_pixels(**LENS, begin=numpy.array([0, 0, 3], numpy.uint64)), focus_pixel=(0, 0))),
    (TypeError, r"^focus_pixel: must be two whole numbers \(x, y\), not \(10.5, 1\)$", lambda: sparselens.gather(two_pixels(**LENS), focus_pixel=(10.5, 1))),
    (sparselens.Error, "depth nan in pixel 0,0 is not a number above 0, as half", lambda: sparselens.View(IMAGE, Z * numpy.float32("nan"))),
    (sparselens.Error, "has depth but no colours", lambda: sparselens.gather(two_pixels(**LENS, channels={}))),
    (ValueError, "path: .*x.png does not end in .exr", lambda: sparselens.write("x.png", two_pixels())),
    (ValueError, "path: .*x.psd ends in no format that is written: .exr, .png", lambda: sparselens.write("x.psd", sparselens.Picture(IMAGE))),
    (ValueError, "tiles applies to EXR, not to .*x.png", lambda: sparselens.write("x.png", sparselens.Picture(IMAGE), tiles=16)),
    (ValueError, "type: applies to EXR, not to .*x.png", lambda: sparselens.write("x.png", sparselens.Picture(IMAGE), type="half")),
    (ValueError, "display and view_transform apply to PNG", lambda: sparselens.write("x.exr", sparselens.Picture(IMAGE), display="sRGB")),
    (ValueError, "fstop: must be a number above 0, or inf, not -1", lambda: sparselens.gather(two_pixels(), fstop=-1)),
    (TypeError, "fstop: must be a number, not str", lambda: sparselens.gather(two_pixels(), fstop="2")),
    (ValueError, "quality: must be one of draft", lambda: sparselens.gather(two_pixels(), quality="best")),
    (ValueError, "quality: works with method='lens'", lambda: sparselens.gather(two_pixels(), method="selective", quality="final")),
    (ValueError, "blades: must be 0 or a whole number", lambda: sparselens.gather(two_pixels(), blades=2.5)),
    (ValueError, "blades: works with method='lens'", lambda: sparselens.gather(two_pixels(), method="selective", blades=5)),
    (TypeError, "device: must be a string", lambda: sparselens.gather(two_pixels(), device=1)),
    (sparselens.Error, "device='no-such': no device has that name|no device here", lambda: sparselens.gather(two_pixels(**LENS), device="no-such")),
    (ValueError, "highlight_gain: must be a number from 1", lambda: sparselens.gather(two_pixels(), highlight_gain=0.5)),
    (ValueError, "highlight_gain: is needed", lambda: sparselens.gather(two_pixels(), highlight_knee=2)),
    (ValueError, "tilt: must be two numbers between", lambda: sparselens.gather(two_pixels(), tilt=(0, 90))),
    (ValueError, "lens_radius: .*fstop", lambda: sparselens.gather(two_pixels(), lens_radius=1, fstop=2)),
    (sparselens.UsageError, "give fstop or lens_radius", lambda: sparselens.gather(two_pixels())),
    (ValueError, "region contains no pixel", lambda: sparselens.gather(two_pixels(**LENS), region=(50, 50, 60, 60))),
    (ValueError, "near works with depth='normalized' and", lambda: sparselens.View(IMAGE, Z, near=1)),
    (ValueError, "depth='hyperbolic': .* is unknown: give near and far$", lambda: sparselens.View(IMAGE, Z, depth="hyperbolic")),
    (TypeError, "views: must be a sequence of View and Ldi, not int", lambda: sparselens.warp([3])),
    (ValueError, "views: there is none", lambda: sparselens.warp([])),
    (ValueError, r"give position=\(X,Y\)$", lambda: sparselens.warp([sparselens.View(IMAGE, Z, **LENS)] * 2)),
    (ValueError, "channels: no channel or layer 'X'", lambda: sparselens.gather(two_pixels(**LENS), channels="X")),
    (TypeError, "channels: must be a str, or a sequence of str", lambda: sparselens.gather(two_pixels(**LENS), channels=[3])),
    (ValueError, "what: must be one of coc, focus, layers, not tiles", lambda: sparselens.show(two_pixels(**LENS), "tiles")),
    (TypeError, "what: must be a str", lambda: sparselens.show(two_pixels(**LENS), 3)),
    (TypeError, "progress: must be callable", lambda: sparselens.gather(two_pixels(**LENS), progress=3)),
    (TypeError, "path: must be a file name", lambda: sparselens.open_view(3)),
    (sparselens.Error, "missing.exr: ", lambda: sparselens.open_ldi("missing.exr")),
    (TypeError, "what: must be an Ldi", lambda: sparselens.write("x.exr", 3)),
    (ValueError, "compression: deep files have", lambda: sparselens.write("x.exr", two_pixels(), compression="dwaa")),
    (sparselens.Error, "display window", lambda: sparselens.compare(IMAGE, IMAGE[1:])),
]


@pytest.mark.parametrize("kind, message, call", WRONG, ids=[text for _, text, _ in WRONG])
def test_wrong_arguments(kind, message, call):
    with pytest.raises(kind, match=message):
        call()


def test_kinds_of_errors():
    assert issubclass(sparselens.UsageError, ValueError) and issubclass(sparselens.Error, RuntimeError)
    assert not issubclass(sparselens.UsageError, sparselens.Error)


def test_layer_of_a_file_with_two_pictures(tmp_path):
    names = [f"{layer}.{channel}" for layer in ("bg", "fg")
             for channel in ("Combined.R", "Combined.G", "Combined.B", "Depth.Z")]
    path = tmp_path / "two.exr"
    values = numpy.broadcast_to(numpy.arange(1, 9, dtype=numpy.float32), (4, 6, 8))
    sparselens.write(path, sparselens.Picture(values, channels=names))
    with pytest.raises(sparselens.UsageError, match="bg.Combined and fg.Combined: give layer with one of bg, fg"):
        sparselens.open_view(path)
    for layer, first in (("bg", 1), ("fg", 5)):
        view = sparselens.open_view(path, layer=layer)
        assert view["R"][0, 0] == first and view.z[0, 0] == first + 3
        assert sparselens.open_ldi(path, layer=layer).z[0] == first + 3
        assert sparselens.open_picture(path, layer=layer)["R"][0, 0] == first
