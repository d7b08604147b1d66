"""match(): the lens of a plate, and plates that cannot be matched."""
import json

import numpy
import pytest
import sparselens

TRUTH = {"focus_distance": 3, "lens_radius": 0.18}


@pytest.fixture(scope="module")
def wide(tool, tmp_path_factory):
    """An LDI of the scene fence whose lens blurs by several pixels."""
    folder = tmp_path_factory.mktemp("wide")
    tool("dof-trace", "fence", "--size", "96x54", "--spp", 16, "--lens-radius", 0.27, "-o", folder)
    views = [sparselens.open_view(folder / name) for name in ("center.exr", *(f"view_{i}.exr" for i in range(4)))]
    sparselens.write(folder / "ldi.exr", sparselens.warp(views))
    return folder / "ldi.exr"


def plate_of(ldi, **lens):
    return sparselens.gather(ldi, overscan="crop", quality="final", **lens)


def black(like):
    return sparselens.Picture(numpy.zeros_like(like.pixels))


def test_match(wide):
    ldi = sparselens.open_ldi(wide)
    plate = plate_of(ldi, **TRUTH)
    said = []
    lens = sparselens.match(ldi, plate, region=(0, 0, 89, 47), progress=lambda stage, percent: said.append(percent))
    assert said[-1] == 100
    for name, value in TRUTH.items():
        low, high = lens[name]["interval"]
        assert low < value < high and lens[name]["value"] == pytest.approx(value, rel=0.03), name
    assert lens["doubt"] == "" and lens["fit"].width == 180
    assert lens["fstop"]["value"] * lens["lens_radius"]["value"] == pytest.approx(ldi.camera.fstop * 0.27)


@pytest.mark.slow
def test_one_value_is_known(wide, tool, tmp_path):
    """Also that dof-match finds the same of the same region."""
    ldi = sparselens.open_ldi(wide)
    plate = plate_of(ldi, **TRUTH)
    lens = sparselens.match(ldi, plate, fit="fstop", focus_distance=3, region=(0, 0, 89, 47))
    assert lens["focus_distance"] == {"value": pytest.approx(3), "interval": pytest.approx((3, 3))}
    assert lens["lens_radius"]["value"] == pytest.approx(0.18, rel=0.03)
    sparselens.write(tmp_path / "plate.exr", plate, type="float")
    tools, = json.loads(tool("dof-match", wide, tmp_path / "plate.exr", "--json", "--region", "0,0,89,47", "--fit", "fstop",
                             "--focus-distance", 3))
    for name in TRUTH:
        assert lens[name]["value"] == tools[name]["value"] and list(lens[name]["interval"]) == tools[name]["interval"], name


@pytest.mark.slow
def test_sequence(wide):
    ldi = sparselens.open_ldi(wide)
    plates = [plate_of(ldi, focus_distance=distance, lens_radius=0.18) for distance in (2.8, 3.0, 3.2)]
    plates[1] = black(plates[1])
    with pytest.warns(UserWarning, match=r"plate\[1\]: .*its values are those of its neighbours"):
        lenses = sparselens.match(ldi, plates, fit="focus", lens_radius=0.18)
    assert [lens["focus_distance"]["value"] for lens in lenses] == pytest.approx([2.8, 3.0, 3.2], rel=0.03)
    assert lenses[0]["lens_radius"] == {"value": pytest.approx(0.18), "interval": pytest.approx((0.18, 0.18))}
    assert [bool(lens["doubt"]) for lens in lenses] == [False, True, False]


def test_refusals(wide):
    ldi = sparselens.open_ldi(wide)
    plate = plate_of(ldi, **TRUTH)
    with pytest.raises(sparselens.Error, match=r"plate\[0\]: .*shows nothing to compare"):
        sparselens.match(ldi, black(plate))
    with pytest.raises(sparselens.Error, match="give a plate of the same size"):
        sparselens.match(ldi, sparselens.Picture(plate.pixels[:40]))
    with pytest.raises(sparselens.UsageError, match="region"):
        sparselens.match(ldi, plate, region=(500, 500, 510, 510))
    with pytest.raises(sparselens.UsageError, match="one of both, focus, fstop"):
        sparselens.match(ldi, plate, fit="lens")
    with pytest.raises(sparselens.UsageError, match="ldi: 2 for 1 plates"):
        sparselens.match([ldi, ldi], [plate])
