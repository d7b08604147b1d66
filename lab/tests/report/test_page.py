"""The page, its plots and its pictures."""
import math

import numpy
import OpenImageIO
import pytest
from measure import around, tone_mapped, worst_block, write_png
from page import draw, draw_plots, page_as_html, rows_in_use
from some_rows import row, sparse, traced


def scene(rows, **more):
    return {"rows": rows, "sentences": [], "plots": [], "more_plots": [], "pictures": [], "worst": []} | more


def test_the_page_holds_all_of_itself():
    rows = traced() + [sparse(2, 5, 39, '<sparse> & "co"')]
    rows[-1].errors[0]["nonfinite_image"] = 12345
    html = page_as_html(["a < machine"], [scene(
        rows, sentences=["1 < 2"], plots=[b"<svg/>"], more_plots=[b"<svg2/>"], worst=[("a > block", b"foob")],
        pictures=[("reference", b"foo"), ("best", b"bar")])])
    assert html.startswith("<!DOCTYPE html>")
    for held in ["a &lt; machine", "1 &lt; 2", "&lt;sparse&gt; &amp; &quot;co&quot;", 'data:image/png;base64,Zm9v"',
                 'data:image/svg+xml;base64,PHN2Zy8+"', 'data:image/svg+xml;base64,PHN2ZzIvPg=="', "a &gt; block",
                 'data:image/png;base64,Zm9vYg=="', ">12345</td>", "startViewer"]:  # 12345: how many are not finite
        assert held in html, held
    assert html.count("<tr") == 1 + len(rows)
    for from_elsewhere in ["http:", "https:", 'src="/', "<link", "@import", "url("]:
        assert from_elsewhere not in html, from_elsewhere


def test_rows_have_as_many_cells_as_titles():
    html = page_as_html([], [scene(traced())])
    assert html.count("</td>") == len(traced()) * html.count("</th>")


def test_a_plot_has_a_line_a_method_and_no_point_at_infinity():
    rows = traced() + [sparse(2, 5, 40, 'say "sparse" for $1$'), row("", "exact", 2, 5, math.inf)]
    for kind, cost in ("seconds", 2), ("rays", 5):
        axes, decibels = draw(rows, kind).axes
        lines = {line.get_label().replace(r"\$", "$"): line.get_xydata().tolist() for line in axes.lines}
        assert list(lines) == ["traced", 'say "sparse" for $1$, lens', "exact, lens"]
        assert lines['say "sparse" for $1$, lens'] == [[cost, pytest.approx(0.01)]]  # 40 dB
        assert lines["exact, lens"] == [] and len(lines["traced"]) == 3
        assert axes.get_ylim() == pytest.approx((0.00562341, 0.0562341), rel=1e-5)
        assert decibels.get_ylim() == (45, 25)  # the same


def test_plots_are_files_of_their_names(tmp_path):
    svg = draw_plots(str(tmp_path / "plots"), traced(), "fence")
    names = {f"fence-{kind}.{ending}" for kind in ("seconds", "rays") for ending in ("svg", "png")}
    assert {path.name for path in (tmp_path / "plots").iterdir()} == names
    assert [b"<svg" in text for text in svg] == [True, True]
    assert svg == draw_plots(str(tmp_path / "again"), traced(), "fence")


def test_plots_show_six_ways_that_are_in_use():
    names = ["one view, scatter", "centre + 4, selective K=8", "4 strata, layered blend", "one view, lens normal",
             "accumulated lens views", "distributed ray tracing", "denoised ray tracing", "centre + 4, lens normal",
             "centre + 8, lens normal", "centre + 4 denoised, lens normal"]
    parts = [name.partition(", ") for name in names]
    kept = rows_in_use([row("", renderer, 1, 5, 30, processor) for renderer, _, processor in parts])
    assert len(kept) == 6 and kept[0].method == "one view, lens normal"  # in the order of the rows
    assert not any(one.processor == "scatter" for one in kept)


def test_pngs_have_the_pixels(tmp_path):
    planes = numpy.linspace(-0.2, 1.2, 3 * 4 * 5, dtype=numpy.float32).reshape(3, 4, 5)
    pixels = planes.transpose(1, 2, 0)  # not contiguous
    pixels[0, 0] = math.nan
    write_png(str(tmp_path / "a" / "b.png"), pixels)
    read = OpenImageIO.ImageBuf(str(tmp_path / "a" / "b.png")).get_pixels("uint8")
    assert read.tolist() == numpy.rint(255 * numpy.clip(numpy.nan_to_num(pixels), 0, 1)).tolist()


def test_the_worst_place_is_shown_beside_the_reference():
    reference = numpy.full((50, 90, 3), 0.5, numpy.float32)
    picture = reference.copy()
    picture[41, 83] = 1
    pair = around([80, 40], picture, reference)
    assert pair.shape == (32, 66, 3)
    assert (pair[:, 32:34] == 1).all() and (pair[:, 34:] == 0.5).all()
    assert pair[41 - 18, 83 - 58, 0] == 1 and pair[:, :32].sum() == 0.5 * (3 * 32 * 32 + 3)  # inside the picture
    picture[0, 0] = math.nan  # is not compared
    picture[20, 10] = 0.7  # less
    assert worst_block(picture, reference) == (80, 40)
    # In the last block, which has two rows of two pixels, a small difference in all pixels is worse than that in one.
    picture[48:, 88:] += 0.2
    assert worst_block(picture, reference) == (88, 48)
    assert (around([0, 0], picture[:20, :30], reference)[20:, :32] == 1).all()  # white beyond a small one


def test_tones_are_those_of_dof_compare():
    values = tone_mapped(numpy.array([-1, 0, 1, 1e30, math.inf]))
    assert values[:4].tolist() == pytest.approx([0, 0, 0.5 ** (1 / 2.2), 1]) and math.isnan(values[4])
