"""Files of other programs: names of colours, depth in a separate file, unpremultiplied colours; tiles, and the lens of
a picture."""
import numpy
import pytest
import sparselens

LENS = {"focal_length": 50, "sensor_width": 36, "lens_radius": 0.1, "focus_distance": 6}
PLAIN, NUKE = ["R", "G", "B", "A"], ["red", "Green", "b", "ALPHA"]


def soft():
    """Colours and depth: a surface with an edge of half coverage at 2 before nothing."""
    pixels = numpy.zeros((24, 32, 4), numpy.float32)
    pixels[4:20, 4:28] = (0.25, 0.125, 0.5, 0.5)
    pixels[6:18, 6:26] = (0.5, 0.25, 1, 1)
    return pixels, numpy.where(pixels[..., 3] > 0, numpy.float32(2), numpy.float32("inf"))


def channels_in(path):
    """The channels among PLAIN and NUKE that the file's list has."""
    listed = path.read_bytes().split(b"channels\0chlist\0")[1].split(b"compression\0")[0]
    return [name for name in PLAIN + NUKE if b"\0" + name.encode() + b"\0" in listed]


def test_names_of_colours(tmp_path):
    pixels, z = soft()
    plain = sparselens.gather(sparselens.warp(sparselens.View(pixels, z, **LENS)))
    view = sparselens.View(pixels, z, channels=NUKE, **LENS)
    assert view.channels == tuple(PLAIN)
    assert numpy.array_equal(view["red"], view["R"]) and numpy.array_equal(view["alpha"], view["A"])
    ldi = sparselens.warp(view)
    picture = sparselens.gather(ldi)
    assert numpy.array_equal(picture.planes, plain.planes)
    sparselens.write(tmp_path / "picture.exr", picture)
    sparselens.write(tmp_path / "ldi.exr", ldi)
    for name in ("picture.exr", "ldi.exr"):
        assert set(channels_in(tmp_path / name)) == set(NUKE), name
    assert sparselens.open_picture(tmp_path / "picture.exr").channels == tuple(PLAIN)
    assert numpy.array_equal(sparselens.open_ldi(tmp_path / "ldi.exr")["red"], ldi["R"])


def test_depth_in_a_file_of_its_own(tmp_path):
    pixels, z = soft()
    sparselens.write(tmp_path / "beauty.exr", sparselens.Picture(pixels))
    sparselens.write(tmp_path / "depth.exr", sparselens.Picture(z))
    for opened in (sparselens.open_view, sparselens.open_ldi):
        with pytest.raises(sparselens.Error, match="give depth_file where it is in a file of its own, else depth_channel"):
            opened(tmp_path / "beauty.exr")
    assert numpy.array_equal(sparselens.open_view(tmp_path / "beauty.exr", depth_file=tmp_path / "depth.exr").z, z)
    assert sparselens.open_ldi(tmp_path / "beauty.exr", depth_file=tmp_path / "depth.exr").z.min() == 2


def test_unpremultiplied(tmp_path):
    pixels, z = soft()
    straight = pixels / numpy.maximum(pixels[..., 3:], 0.5)
    straight[..., 3] = pixels[..., 3]
    assert numpy.array_equal(sparselens.View(straight, z, unpremultiplied=True).pixels, pixels)
    sparselens.write(tmp_path / "straight.exr", sparselens.Picture(straight))
    assert numpy.array_equal(sparselens.open_picture(tmp_path / "straight.exr", unpremultiplied=True).pixels, pixels)


def test_tiles(tmp_path):
    picture = sparselens.Picture(soft()[0])
    sparselens.write(tmp_path / "tiled.exr", picture, tiles=16)
    assert (tmp_path / "tiled.exr").read_bytes()[5] == 2  # the flag of tiles
    assert numpy.array_equal(sparselens.open_picture(tmp_path / "tiled.exr").pixels, picture.pixels)


def test_distance_that_focus_pixel_found():
    pixels, z = soft()
    lens = {**LENS, "focus_distance": None}
    ldi = sparselens.warp(sparselens.View(pixels, z, **lens))
    assert sparselens.gather(ldi, focus_pixel=(16, 12)).camera.focus_distance == 2


def test_no_lens_is_needed_to_merge_what_is_equal():
    pixels, z = soft()
    ldi = sparselens.warp(sparselens.View(pixels, z, focal_length=50, sensor_width=36))
    assert sparselens.cluster(ldi, tolerance=0).samples == ldi.samples
    with pytest.raises(sparselens.UsageError, match="fstop"):
        sparselens.cluster(ldi, tolerance=0.1)
