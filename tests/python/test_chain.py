"""The chain on the scene fence: every function gives the bytes of its tool."""
import json
import math
import subprocess
import warnings

import numpy
import pytest
import sparselens


def saved(folder, what):
    """The bytes of the file written from it."""
    sparselens.write(folder / "python.exr", what)
    return (folder / "python.exr").read_bytes()


def test_warp(views, warped, tmp_path):
    sparselens.write(tmp_path / "warped.exr", sparselens.warp(views))
    assert (tmp_path / "warped.exr").read_bytes() == warped.read_bytes()


@pytest.mark.parametrize("keywords", [{"merge": "keep"}, {"silhouettes": "whole"}, {"agreement": "assume"},
                                      {"optical": "off"}])
def test_warp_keywords(views, names, warped, tool, tmp_path, keywords):
    (name, value), = keywords.items()
    tool("ldi-warp", *names, "--" + name, value, "-o", tmp_path / "tool.exr")
    sparselens.write(tmp_path / "python.exr", sparselens.warp(views, **keywords))
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()
    if name not in ("agreement", "optical"):  # fence has no mirrors
        assert (tmp_path / "tool.exr").read_bytes() != warped.read_bytes()


@pytest.mark.slow
def test_warp_denoised(names, views, tool, tmp_path):
    """The denoiser here is a mean over a square."""
    denoised = []
    for k, name in enumerate(names):
        denoised.append(tmp_path / f"denoised_{k}.exr")
        subprocess.run(["oiiotool", name, "--dup", "--ch", "R,G,B", "--blur:kernel=box", "3x3", "-o", denoised[k]], check=True)
    tool("ldi-warp", *names, "--denoised", *denoised, "-o", tmp_path / "tool.exr")
    pictures = [sparselens.open_picture(name) for name in denoised]
    assert (tmp_path / "tool.exr").read_bytes() == saved(tmp_path, sparselens.warp(views, denoised=pictures))
    for view, noisy, smooth in zip(["a", "b"], names, denoised):
        both = tmp_path / f"{view}.exr"
        subprocess.run(["oiiotool", smooth, noisy, "--ch", "Noisy Image.R=R,Noisy Image.G=G,Noisy Image.B=B", "--chappend",
                        noisy, "--ch", "A,Z", "--chappend", "-o", both], check=True)
    tool("ldi-warp", tmp_path / "a.exr", tmp_path / "b.exr", "--noisy", "Noisy Image", "-o", tmp_path / "tool.exr")
    both = [sparselens.open_view(tmp_path / name) for name in ("a.exr", "b.exr")]
    assert (tmp_path / "tool.exr").read_bytes() == saved(tmp_path, sparselens.warp(both, noisy="Noisy Image"))
    with pytest.raises(sparselens.UsageError, match="exclude"):
        sparselens.warp(both, noisy="Noisy Image", denoised=pictures[:2])
    with pytest.raises(sparselens.UsageError, match="denoised: there are 2 of them for 5 views"):
        sparselens.warp(views, denoised=pictures[:2])
    with pytest.raises(TypeError, match="denoised"):
        sparselens.warp(views, denoised=denoised)


def on_device(verb, *arguments, **keywords):
    """With the software device; skipped if there is none. If the device fails and the CPU takes over, there is only a
    warning."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return verb(*arguments, device="llvmpipe", **keywords)
    except sparselens.Error as error:
        if "no device has that name" not in str(error):
            raise
        pytest.skip(str(error))


def test_warp_device(views):
    by_device = on_device(sparselens.warp, views)
    by_cpu = sparselens.warp(views)
    assert numpy.array_equal(by_device.begin, by_cpu.begin)
    for name in by_cpu.channels:
        assert numpy.array_equal(by_device[name], by_cpu[name])
    with pytest.raises(sparselens.Error, match="no device has that name"):
        sparselens.warp(views, device="no-such")


def test_warp_is_what_is_written(views, warped):
    ldi, read = sparselens.warp(views), sparselens.open_ldi(warped)
    assert numpy.array_equal(ldi.begin, read.begin)
    assert numpy.array_equal(ldi.z, read.z)  # float32 in the file; colours are half: 11 bits
    assert numpy.allclose(ldi["R"], read["R"], rtol=2**-11, atol=2**-25)


@pytest.mark.parametrize("keywords", [{}, {"tolerance": 2}, {"layers": 2}, {"lens_radius": 0.02}])
def test_cluster(warped, tool, tmp_path, keywords):
    options = [word for name, value in keywords.items() for word in ("--" + name.replace("_", "-"), value)]
    tool("ldi-cluster", warped, *options, "-o", tmp_path / "tool.exr")
    sparselens.write(tmp_path / "python.exr", sparselens.cluster(sparselens.open_ldi(warped), **keywords))
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()


def test_cluster_merges(clustered, tool, tmp_path):
    ldi = sparselens.open_ldi(clustered)
    tool("ldi-cluster", clustered, clustered, "-o", tmp_path / "tool.exr")
    sparselens.write(tmp_path / "python.exr", sparselens.cluster([ldi, ldi]))
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()


def test_cluster_takes_the_lens_that_is_given_for_that_of_all(clustered):
    ldi, wider = sparselens.open_ldi(clustered), sparselens.open_ldi(clustered, focal_length=30)
    with pytest.raises(sparselens.Error, match="give focal_length and sensor_width"):
        sparselens.cluster([ldi, wider])
    merged = sparselens.cluster([ldi, wider], focal_length=36, sensor_width=36)
    assert numpy.array_equal(merged.z, sparselens.cluster([ldi, ldi]).z)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_recolor(clustered, tool, tmp_path):
    beauty = tmp_path / "beauty.exr"
    sparselens.write(beauty, sparselens.gather(sparselens.open_ldi(clustered), lens_radius=0))
    tool("ldi-cluster", clustered, "--recolor", beauty, "-o", tmp_path / "tool.exr")
    picture = sparselens.open_picture(beauty)
    ldi = sparselens.cluster(sparselens.open_ldi(clustered), recolor=picture)
    sparselens.write(tmp_path / "python.exr", ldi)
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()
    assert numpy.abs(sparselens.flatten(ldi)["R"] - picture["R"]).max() < 1e-3 * picture["R"].max()
    with pytest.raises(TypeError, match="recolor"):
        sparselens.cluster(ldi, recolor=beauty)


# Every number of the table of looks, but for the blades.
NUMBERS_OF_LOOKS = {row["name"]: 0.5 for row in sparselens._sparselens._parameters() if row["group"] == "Lens looks"
                    and row["wanted"].startswith("a number from") and not row["name"].startswith("blade")}
GATHERS = [
    {},
    {"focus_distance": 2.2},
    {"fstop": 1.4},
    {"lens_radius": 0},
    {"quality": "final"},
    {"lens_samples": 7},
    {"layer_tolerance": 9},
    {"method": "selective", "layers": 2},
    {"region": (10, 20, 49, 69)},
    {"proxy": 2},
    {"supersample": 2},
    {"supersample": 2, "pixel_filter": "blackman-harris", "region": (5, 2, 20, 12), "focus_pixel": (16, 9)},
    {"supersample": 2, "proxy": 2},
    {"overscan": "keep"},
    {"focus_pixel": (48, 27)},
    {"focal_length": 30, "sensor_width": 30},
    {"blades": 5, "blade_rotation": 10, "cat_eye": 0.5},
    {"spherical": 0.5, "axial_chromatic": 0.2, "axial_chromatic_type": "blue-yellow"},
    {"tilt": (10, 0), "field_curvature": 0.1, "astigmatism": 0.2, "breathing": 1},
    {"squeeze": 2},
    NUMBERS_OF_LOOKS,
    {"highlight_gain": 4, "highlight_threshold": 0.5, "highlight_knee": 2},
]


def options_of(keywords):
    for name, value in keywords.items():
        yield "--" + name.replace("_", "-")
        yield ",".join(map(str, value)) if isinstance(value, tuple) else value


@pytest.mark.parametrize("keywords", GATHERS, ids=str)
def test_gather(clustered, tool, tmp_path, keywords):
    tool("dof-gather", clustered, *options_of(keywords), "-o", tmp_path / "tool.exr")
    sparselens.write(tmp_path / "python.exr", sparselens.gather(sparselens.open_ldi(clustered), **keywords))
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()


def test_gather_sub_pixels(views, names, tool, tmp_path):
    """A pixel of the picture is 3 x 3 pixels of the views: region and focus pixel count the picture's pixels."""
    keywords = {"supersample": 3, "pixel_filter": "blackman-harris", "region": (5, 2, 20, 12), "focus_pixel": (16, 9)}
    warped = tmp_path / "warped.exr"
    tool("ldi-warp", *names, "--supersample", 3, "-o", warped)
    assert warped.read_bytes() == saved(tmp_path, sparselens.warp(views, supersample=3))
    tool("dof-gather", warped, *options_of(keywords), "-o", tmp_path / "tool.exr")
    picture = sparselens.gather(sparselens.open_ldi(warped), **keywords)
    assert (tmp_path / "tool.exr").read_bytes() == saved(tmp_path, picture)
    assert (picture.width, picture.height) == (16, 11)


def test_moments(clustered, warped, tool, tmp_path):
    files = [clustered, warped, clustered]
    for number, file in enumerate(files):
        (tmp_path / f"ldi_{number}.exr").write_bytes(file.read_bytes())
    tool("dof-gather", tmp_path / "ldi_%s.exr", "-o", tmp_path / "tool.exr", "--shutter-curve", "triangle",
         "--rolling-shutter", "0.5")
    ldis = [sparselens.open_ldi(file) for file in files]
    picture = sparselens.gather(ldis, shutter_curve="triangle", rolling_shutter=0.5)
    assert (tmp_path / "tool.exr").read_bytes() == saved(tmp_path, picture)
    assert numpy.array_equal(sparselens.gather(ldis[:1]).planes, sparselens.gather(ldis[0]).planes)
    with pytest.raises(sparselens.UsageError, match="shutter_curve: needs the moments of a shutter"):
        sparselens.gather(ldis[0], shutter_curve="box")
    with pytest.raises(sparselens.UsageError, match="rolling_shutter: needs the moments of a shutter"):
        sparselens.gather(ldis[0], rolling_shutter=0.5)
    with pytest.raises(TypeError, match="an Ldi, or a sequence of the moments of a shutter"):
        sparselens.gather([ldis[0], 3])


def test_missing_overscan_is_warned_of():
    """A lamp at the border, with a disc 4.7 pixels across, and no lamp there."""
    for lamp in (7 * 40, 15 * 40 + 20):
        light = numpy.full(1200, 0.5, numpy.float32)
        light[lamp] = 50
        channels = dict.fromkeys("RGB", light) | {"A": numpy.ones(1200, numpy.float32)}
        ldi = sparselens.Ldi(numpy.arange(1201, dtype=numpy.uint64), numpy.full(1200, 12.886, numpy.float32), channels,
                             size=(40, 30), focal_length=640, sensor_width=40, lens_radius=0.06, focus_distance=5)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            sparselens.gather(ldi, quality="draft")
        assert [str(one.message).endswith("render more overscan") for one in said] == ([True] if lamp == 280 else [])


@pytest.mark.parametrize("method", ["lens", "selective"])
def test_device(clustered, method):
    ldi = sparselens.open_ldi(clustered)
    for distance in (2.5, 3):
        picture = on_device(sparselens.gather, ldi, method=method, focus_distance=distance)
        by_cpu = sparselens.gather(ldi, method=method, focus_distance=distance)
        assert numpy.abs(picture.planes - by_cpu.planes).max() <= 1e-4 * by_cpu.planes.max()


@pytest.mark.parametrize("defocused", [False, True])
def test_holdout(clustered, tool, tmp_path, defocused):
    ldi = sparselens.open_ldi(clustered)
    near = ldi.z < 3
    begin = numpy.concatenate([[0], numpy.cumsum(near)])[ldi.begin.astype(numpy.int64)].astype(numpy.uint64)
    channels = {name: ldi[name][near] for name in ldi.channels}
    fence = sparselens.Ldi(begin, ldi.z[near], channels, size=(ldi.width, ldi.height),
                           data_window=ldi.data_window, display_window=ldi.display_window)
    sparselens.write(tmp_path / "fence.exr", fence)
    more = ["--holdout-defocused"] if defocused else []
    tool("dof-gather", clustered, "--holdout", tmp_path / "fence.exr", *more, "-o", tmp_path / "tool.exr")
    picture = sparselens.gather(ldi, holdout=sparselens.open_ldi(tmp_path / "fence.exr"),
                                holdout_defocused=defocused)
    sparselens.write(tmp_path / "python.exr", picture)
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()


def test_write_for_the_screen(clustered, tool, tmp_path):
    tool("dof-gather", clustered, "-o", tmp_path / "tool.png")
    sparselens.write(tmp_path / "python.png", sparselens.gather(sparselens.open_ldi(clustered)))
    assert (tmp_path / "python.png").read_bytes() == (tmp_path / "tool.png").read_bytes()


def test_notebook(clustered, tmp_path):
    """A notebook shows the file for the screen; a picture without colours is shown as text."""
    picture = sparselens.gather(sparselens.open_ldi(clustered))
    sparselens.write(tmp_path / "shown.png", picture)
    assert picture._repr_png_() == (tmp_path / "shown.png").read_bytes()
    assert sparselens.front_depth(sparselens.open_ldi(clustered))._repr_png_() is None


def test_write_type_and_compression(clustered, tool, tmp_path):
    tool("dof-gather", clustered, "-d", "float", "--compression", "piz", "-o", tmp_path / "tool.exr")
    picture = sparselens.gather(sparselens.open_ldi(clustered))
    sparselens.write(tmp_path / "python.exr", picture, type="float", compression="piz")
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()


def test_flatten(clustered):
    ldi = sparselens.open_ldi(clustered)
    pinhole = sparselens.gather(ldi, lens_radius=0)
    assert numpy.array_equal(sparselens.flatten(ldi).planes, pinhole.planes)


@pytest.mark.parametrize("what", ["coc", "focus", "layers"])
def test_show(clustered, tool, tmp_path, what):
    ldi = sparselens.open_ldi(clustered)
    tool("dof-gather", clustered, "--show", what, "--focus-distance", 3, "--overscan", "keep", "-o", tmp_path / "tool.exr")
    shown = sparselens.show(ldi, what, focus_distance=3)
    by_tool = sparselens.open_picture(tmp_path / "tool.exr")
    assert shown.channels == by_tool.channels and shown.data_window == by_tool.data_window
    assert numpy.array_equal(shown.planes.astype(numpy.float16), by_tool.planes.astype(numpy.float16))


def test_front_depth(clustered, tool, tmp_path):
    tool("dof-gather", clustered, "--depth-out", tmp_path / "z.exr", "--overscan", "keep", "-o", tmp_path / "tool.exr")
    depth = sparselens.front_depth(sparselens.open_ldi(clustered))
    assert depth.channels == ("Z",) and depth.planes.dtype == numpy.float32
    assert numpy.array_equal(depth["Z"], sparselens.open_picture(tmp_path / "z.exr")["Z"])


@pytest.mark.parametrize("channels", ["R", ["R", "G"], ("rgba",)], ids=str)
def test_channels(clustered, tool, tmp_path, channels):
    given = channels if isinstance(channels, str) else ",".join(channels)
    tool("dof-gather", clustered, "--channels", given, "-o", tmp_path / "tool.exr")
    sparselens.write(tmp_path / "python.exr", sparselens.gather(sparselens.open_ldi(clustered), channels=channels))
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "tool.exr").read_bytes()


def test_plan_of_moments(tool, tmp_path):
    tool("dof-trace", "fair", "--size", "160x90", "--spp", 8, "--views", 0, "--moments", 2, "-o", tmp_path)
    tool("ldi-plan", tmp_path / "center_%s.exr", "-o", tmp_path / "tool.json")
    plan = sparselens.plan([sparselens.open_view(tmp_path / f"center_{moment}.exr") for moment in (0, 1)])
    by_tool = json.loads((tmp_path / "tool.json").read_text())
    assert plan.moments == by_tool["moments"] > 1
    assert plan.motion == pytest.approx(by_tool["motion"])
    with pytest.raises(TypeError, match="a View, or a sequence of the moments of a shutter"):
        sparselens.plan([1])


def test_plan(views, names, tool, tmp_path):
    tool("ldi-plan", names[0], "--views", 3, "--margin", 1, "--rays", 320, "--masks", tmp_path / "tool",
         "-o", tmp_path / "tool.json")
    plan = sparselens.plan(views[0], views=3, margin=1, rays=320)
    assert plan.rays["views"] == len(plan.views) + 1
    assert plan.rays["views"] * plan.rays["samples"] * plan.rays["supersample"] ** 2 + 2 * plan.rays["per_render"] == 320
    told = json.loads((tmp_path / "tool.json").read_text())["rays"]
    assert plan.rays == {**told, "noise_db": pytest.approx(told["noise_db"])} and plan.rays["noise_db"] > 20
    assert sparselens.plan(views[0]).rays is None
    with pytest.raises(sparselens.UsageError, match="too few"):
        sparselens.plan(views[0], views=3, rays=1)
    sparselens.write(tmp_path / "python.json", plan, masks=tmp_path / "python")
    assert plan.moments is None and plan.motion is None
    by_tool = json.loads((tmp_path / "tool.json").read_text())
    by_python = json.loads((tmp_path / "python.json").read_text().replace("python/", "tool/"))
    assert by_python == by_tool
    assert plan.supersample == by_tool["supersample"]
    for k, view in enumerate(plan.views):
        mask = f"view_{k}.exr"
        assert (tmp_path / "python" / mask).read_bytes() == (tmp_path / "tool" / mask).read_bytes()
        assert view.mask.shape == (54, 96) and view.mask.dtype == bool
        assert view.share == view.mask.mean() == by_tool["views"][k]["share"]
        assert [list(box) for box in view.rectangles] == by_tool["views"][k]["rectangles"]
        assert math.isclose(math.hypot(*view.lens_point), 1)


def none_for_what_json_lacks(figures):
    if isinstance(figures, dict):
        return {name: none_for_what_json_lacks(value) for name, value in figures.items()}
    return figures if math.isfinite(figures) else None


def test_compare(views, names, clustered, tool, tmp_path):
    tool("dof-gather", clustered, "-o", tmp_path / "picture.exr")
    arguments = [tmp_path / "picture.exr", names[0], "--regions", clustered, "--focus-distance", 3, "--json"]
    by_tool = json.loads(tool("dof-compare", *arguments))
    picture = sparselens.open_picture(tmp_path / "picture.exr")
    regions = sparselens.open_ldi(clustered)
    figures = sparselens.compare(picture, views[0], regions=regions, focus_distance=3)
    assert none_for_what_json_lacks(figures) == by_tool
    pixels = numpy.ascontiguousarray(picture.pixels)
    assert sparselens.compare(pixels, views[0])["psnr"] == by_tool["psnr"]
    assert math.isinf(sparselens.compare(picture, picture)["psnr"])
    fine = sparselens.cluster(regions, supersample=2)
    assert "regions" in sparselens.compare(*[sparselens.gather(fine, quality="draft")] * 2, regions=fine)


def test_finish(clustered, names, tool, tmp_path):
    tool("dof-gather", clustered, "-o", tmp_path / "gathered.exr", "-d", "float")
    files = [tmp_path / "gathered.exr", *(names[0].with_name(f"rays_{k}.exr") for k in (1, 2))]
    tool("dof-finish", *files, "-o", tmp_path / "final.exr", "--stats", tmp_path / "stats.json")
    by_tool = json.loads((tmp_path / "stats.json").read_text())
    gathered, *rays = [sparselens.open_picture(file) for file in files]
    finished = sparselens.finish(gathered, rays)
    assert numpy.array_equal(finished["picture"].pixels, sparselens.open_picture(tmp_path / "final.exr").pixels)
    assert finished["psnr"] == by_tool["estimated_psnr"] and finished["mse"] == by_tool["estimated_mse"]
    assert finished["mse_deviation"] == by_tool["estimated_mse_deviation"]
    assert finished["trust"]["Y"].mean() == pytest.approx(by_tool["kept"], abs=1e-5)
    assert 0 < finished["error"]["Y"].mean() < 0.1
    unequal = sparselens.finish(gathered, rays, samples=[64, 16], denoised=rays)
    assert not numpy.array_equal(unequal["picture"].pixels, finished["picture"].pixels)
    more = sparselens.finish(gathered, rays, around=[(gathered, rays[::-1])])
    assert more["mse"] < finished["mse"]
    tool("dof-gather", clustered, "--output-colorspace", "ACEScg", "-d", "float", "-o", tmp_path / "aces.exr")
    tool("dof-finish", tmp_path / "aces.exr", *files[1:], "-o", tmp_path / "final.exr")
    with pytest.warns(UserWarning, match=r"rays\[1\]: its colours are in another space than those of gathered"):
        converted = sparselens.finish(sparselens.open_picture(tmp_path / "aces.exr"), rays)
    assert numpy.array_equal(converted["picture"].pixels, sparselens.open_picture(tmp_path / "final.exr").pixels)
    with pytest.warns(UserWarning, match=r"rays\[0\]: another lens or camera .*: focus at"):
        sparselens.finish(sparselens.gather(sparselens.open_ldi(clustered), focus_distance=2), rays)
    with pytest.raises(sparselens.UsageError, match="around: 1 for 2"):
        sparselens.finish(gathered, rays, around=[(gathered, rays[:1])])
    with pytest.raises(TypeError, match="around"):
        sparselens.finish(gathered, rays, around=[gathered])
    with pytest.raises(sparselens.UsageError, match="the noise of a single render is unknown"):
        sparselens.finish(gathered, rays[:1])
    with pytest.raises(sparselens.UsageError, match="samples: 1 for 2"):
        sparselens.finish(gathered, rays, samples=[64])
    with pytest.raises(sparselens.UsageError, match="denoised: 1 for 2"):
        sparselens.finish(gathered, rays, denoised=rays[:1])
    with pytest.raises(TypeError, match="rays"):
        sparselens.finish(gathered, 3)


def test_a_photograph_is_gathered_as_the_tool_does(views, tool, tmp_path):
    photo, depth = tmp_path / "photo.png", tmp_path / "depth.png"
    near = numpy.float32(views[0].z.min()) / views[0].z
    sparselens.write(photo, sparselens.Picture(views[0].pixels[:, :, :3]))
    sparselens.write(depth, sparselens.Picture(numpy.repeat(near[:, :, None], 3, axis=2)), view_transform="Raw")
    ldi = sparselens.open_ldi(photo, depth_file=depth)
    sparselens.write(tmp_path / "python.png", sparselens.gather(ldi, blur=5, focus_pixel=(48, 27)))
    tool("dof-gather", photo, "--depth-file", depth, "--blur", 5, "--focus-pixel", "48,27", "-o", tmp_path / "tool.png")
    assert (tmp_path / "python.png").read_bytes() == (tmp_path / "tool.png").read_bytes() != photo.read_bytes()
    usual, said = (sparselens.gather(ldi, **given).pixels for given in ({}, dict(blur="2%", quality="final")))
    assert numpy.array_equal(usual, said)
    with pytest.raises(sparselens.UsageError, match="blur: must be a number .* share of the picture's width .*, not 2%%"):
        sparselens.gather(ldi, blur="2%%")
    with pytest.raises(sparselens.UsageError, match="fstop"):
        sparselens.gather(ldi, blur=5, fstop=2, focus_pixel=(48, 27))
