"""The node for ComfyUI (share/comfyui), with a stand-in for torch: ComfyUI's pictures are tensors (n, height, width, 3)."""
import importlib
import pathlib
import sys
import types

import numpy
import pytest


class Tensor:
    def __init__(self, array):
        self.array = array

    def cpu(self):
        return self

    def numpy(self):
        return self.array


@pytest.fixture(scope="module")
def node():
    share = pathlib.Path(__file__).resolve().parents[2] / "share" / "comfyui"
    sys.modules["torch"] = types.SimpleNamespace(from_numpy=Tensor)
    sys.path.insert(0, str(share))
    try:
        module = importlib.import_module("sparselens_comfyui")
    finally:
        sys.path.remove(str(share))
        del sys.modules["torch"]
    (name,) = module.NODE_CLASS_MAPPINGS
    assert module.NODE_DISPLAY_NAME_MAPPINGS[name]
    made = module.NODE_CLASS_MAPPINGS[name]
    taking = getattr(made(), made.FUNCTION)

    def take(image, depth, **options):
        given = {key: row[1]["default"] for key, row in made.INPUT_TYPES()["required"].items() if len(row) > 1}
        (taken,) = taking(Tensor(image), Tensor(depth), **{**given, **options})
        assert taken.array.dtype == numpy.float32
        return taken.array

    return take


HEIGHT, WIDTH = 48, 64


def stripes():
    """Stripes of 2 pixels; the left half is near (white), the right half far."""
    x = numpy.arange(WIDTH)
    image = numpy.repeat(numpy.tile(numpy.where(x // 2 % 2, 0.8, 0.2), (HEIGHT, 1))[None, :, :, None], 3, axis=3)
    depth = numpy.repeat(numpy.tile(numpy.where(x < WIDTH // 2, 0.9, 0.1), (HEIGHT, 1))[None, :, :, None], 3, axis=3)
    return image.astype(numpy.float32), depth.astype(numpy.float32)


def contrast(picture, left):
    part = picture[0, 8:-8, 8:24] if left else picture[0, 8:-8, 40:56]
    return float(part.max() - part.min())


def test_what_is_in_focus_stays_sharp_and_the_rest_is_blurred(node):
    image, depth = stripes()
    near = node(image, depth, blur=6.0, focus_x=0.25)
    assert contrast(near, left=True) == pytest.approx(0.6, abs=0.01)
    assert contrast(near, left=False) < 0.15
    far = node(image, depth, blur=6.0, focus_x=0.75)
    assert contrast(far, left=True) < 0.15
    assert contrast(far, left=False) == pytest.approx(0.6, abs=0.01)


def test_a_disc_has_the_radius_that_blur_says(node):
    image = numpy.zeros((1, HEIGHT, WIDTH, 3), numpy.float32)
    image[0, 24, 40] = 1
    depth = numpy.full((1, HEIGHT, WIDTH, 3), 0.25, numpy.float32)
    depth[0, :, :8] = 0.75  # in focus: the CoC of the rest is half of the blur
    taken = node(image, depth, blur=12.0, focus_x=0.01)
    lit = numpy.argwhere(taken[0, :, :, 0] > 0.02)
    assert 5 <= (lit[:, 0].max() - lit[:, 0].min() + 1) / 2 <= 7.5
    assert lit.mean(axis=0) == pytest.approx([24, 40], abs=0.5)


def test_light_is_averaged_and_not_its_code(node):
    image, depth = stripes()
    taken = node(image, depth, blur=20.0, focus_x=0.25)
    mean = taken[0, 20:28, 46:50].mean()
    assert mean == pytest.approx(0.58, abs=0.03)  # 0.5 if codes were averaged


def test_without_blur_nothing_changes(node):
    image, depth = stripes()
    assert numpy.array_equal(node(image, depth, blur=0.0), image)


def test_one_depth_serves_all_pictures(node):
    image, depth = stripes()
    both = node(numpy.concatenate([image, image[:, :, ::-1]]), depth, blur=4.0, focus_x=0.25)
    assert both.shape == (2, HEIGHT, WIDTH, 3)
    assert numpy.array_equal(both[:1], node(image, depth, blur=4.0, focus_x=0.25))


def test_a_depth_may_lack_channels(node):
    image, depth = stripes()
    with_channels = node(image, depth, blur=4.0)
    assert numpy.array_equal(node(image, depth[:, :, :, 0], blur=4.0), with_channels)
    assert numpy.array_equal(node(image, depth[0, :, :, 0], blur=4.0), with_channels)
    assert numpy.array_equal(node(image, depth[:, :, :, :1], blur=4.0), with_channels)
    with pytest.raises(ValueError, match="the depth has 32 x 48 pixels, the picture 64 x 48"):
        node(image, depth[:, :, ::2, 0])


def test_other_sizes_and_numbers_are_named(node):
    image, depth = stripes()
    with pytest.raises(ValueError, match="the depth has 32 x 48 pixels, the picture 64 x 48"):
        node(image, depth[:, :, ::2])
    with pytest.raises(ValueError, match="3 pictures and 2 depths"):
        node(numpy.repeat(image, 3, axis=0), numpy.repeat(depth, 2, axis=0))
