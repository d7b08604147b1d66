"""Curves, verdicts and tables of rows."""
import csv
import io
import math

import pytest
from rows import (FIGURES, REGIONS, Verdict, as_csv, compared, curve_of, fixed, quality_at, ray_tracing_curves,
                  reached_at, reached_text, shortest, significant, summary)
from some_rows import row, sparse, traced

DOUBLING = [(1, 30), (4, 36), (16, 42)]  # 3 dB whenever the cost doubles


def test_numbers_as_text():
    assert [fixed(2.345, 1), fixed(math.inf, 2), fixed(math.nan, 2)] == ["2.3", "inf", "-"]
    assert [significant(1024, 3), significant(0.25, 3), significant(math.nan, 3)] == ["1.02e+03", "0.25", "-"]
    assert [shortest(0.1), shortest(50), shortest(math.inf), shortest(math.nan)] == ["0.1", "50", "inf", ""]


def test_a_curve_is_sorted_and_keeps_the_best_of_a_cost():
    points = [(4, 36), (1, 29), (1, 30), (2, math.nan), (8, math.inf), (0, 20), (math.inf, 50)]
    assert curve_of(points) == [(1, 30), (4, 36)]
    assert curve_of([]) == []


def test_a_curve_is_linear_in_the_logarithm_of_cost():
    assert quality_at(DOUBLING, 2) == pytest.approx(33, abs=1e-12)
    assert quality_at(DOUBLING, 8) == pytest.approx(39, abs=1e-12)
    assert quality_at(DOUBLING, 4) == 36
    bound, cost = reached_at(DOUBLING, 33)
    assert bound == "" and cost == pytest.approx(2, abs=1e-12)


def test_a_curve_is_never_extrapolated():
    assert quality_at(DOUBLING, 0.999) is None and quality_at(DOUBLING, 16.001) is None and quality_at([], 1) is None
    assert quality_at(DOUBLING, 1) == 30 and quality_at(DOUBLING, 16) == 42
    assert reached_at(DOUBLING, 29) == ("<", 1)
    assert reached_at(DOUBLING, 42.001) == (">", 16)
    assert reached_at([], 30) is None
    assert reached_at(DOUBLING, math.nan)[0] == ">"  # NaN is never reached


def test_one_point_says_no_more_than_itself():
    assert quality_at([(3, 40)], 3) == 40 and quality_at([(3, 40)], 2.9) is None
    assert reached_at([(3, 40)], 40) == ("", 3) and reached_at([(3, 40)], 39)[0] == "<"


def test_a_curve_that_falls_counts_from_where_it_first_reached():
    noisy = [(1, 30), (2, 40), (4, 35), (8, 45)]
    assert reached_at(noisy, 35)[1] == pytest.approx(math.sqrt(2), abs=1e-12)
    assert reached_at(noisy, 42.5)[1] == pytest.approx(4 * 2 ** 0.75, abs=1e-12)


def test_quality_and_cost_are_inverse():
    for k in range(30):
        cost = 1.1 ** k
        if cost <= 16:
            assert reached_at(DOUBLING, quality_at(DOUBLING, cost))[1] == pytest.approx(cost, rel=1e-9)


def text_of(rows):
    return "\n".join(Verdict(rows).sentences())


def test_equal_error_and_equal_time_are_read_off_the_curve():
    rows = traced() + [sparse(2, 5, 39)]
    seconds, rays, gained = compared(rows[-1], ray_tracing_curves(rows))
    assert seconds[0] == "" and seconds[1] == pytest.approx(8, abs=1e-9)  # four times as long
    assert rays[1] == pytest.approx(32, abs=1e-9) and gained == pytest.approx(6, abs=1e-9)
    assert reached_text(seconds, 2) == "4"


def test_what_was_not_measured_is_a_bound_or_nothing():
    rows = traced() + [sparse(0.5, 5, 29), sparse(20, 80, 43)]
    quick, good = (compared(one, ray_tracing_curves(rows)) for one in rows[3:])
    assert quick[2] is None and good[2] is None
    assert reached_text(quick[0]) == "< 1" and reached_text(good[1]) == "> 64" and reached_text(None) == "-"


def test_the_crossing_is_where_ray_tracing_passes_the_best_sparse_row():
    rows = traced() + [sparse(2, 5, 37), sparse(3, 20, 39), row("", "strata", 3, 20, 41)]
    verdict = Verdict(rows)
    assert verdict.best is rows[4] and verdict.below == rows[3:5]
    assert verdict.seconds[1] == pytest.approx(8, abs=1e-9) and verdict.rays[1] == pytest.approx(32, abs=1e-9)
    assert "passes it at 8 s, 32 rays a pixel" in text_of(rows)


def test_the_verdict_names_where_ray_tracing_is_better():
    # Ray tracing needs 6.3 s for 38 dB, so the row of 10 s is of no use.
    rows = traced() + [sparse(2, 5, 37, "quick"), sparse(10, 40, 38, "slow")]
    assert Verdict(rows).slower == [rows[4]]
    assert "the better choice: slow, lens at 40 rays." in text_of(rows)
    assert Verdict(rows).below == [rows[3]]  # the other one is not compared further


def test_ray_tracing_that_is_better_from_the_start_is_said_to_be():
    assert "better from its smallest measured budget on" in text_of(traced() + [sparse(2, 5, 29)])
    never = text_of(traced() + [sparse(2, 5, 50)])
    assert "does not reach it with the largest measured budget (16 s, 64 rays a pixel)." in never
    assert "which of the two is better there was not measured" in text_of(traced() + [sparse(20, 5, 50)])


def test_rows_that_others_beat_are_named():
    ours = [sparse(2, 5, 37), sparse(3, 20, 40)]

    def beaten(*others):
        return Verdict(traced() + ours + list(others)).beaten
    assert beaten() == []
    assert beaten(row("", "faster but worse", 1, 5, 36)) == []
    assert beaten(row("", "better but slower", 2.5, 5, 39)) == []
    assert beaten(row("", "the same", 2, 5, 37)) == []
    assert beaten(sparse(1.9, 5, 38, "one of ours")) == []
    better, best = row("", "as fast and better", 2, 5, 38), row("", "faster and better still", 1, 5, 39)
    (found, by, others), = beaten(better, best)
    assert found is ours[0] and by is best and others == 1


def test_nothing_is_claimed_where_nothing_was_measured():
    assert "No sparse views seen through the lens were measured." in text_of(traced())
    assert "No ray tracing of the lens was measured." in text_of([sparse(2, 5, 37)])
    # The only row takes longer than the crossing, so the verdict does not mention slower rows.
    slow = text_of(traced() + [sparse(10, 40, 38, "slow")])
    assert "No sparse row with the lens gather takes less time than that." in slow


def test_the_summary_says_what_the_rows_gained():
    text = summary(traced() + [sparse(2, 5, 39)])
    assert "passes it at 8 s, 32 rays a pixel" in text
    lines = text.splitlines()
    assert lines[:2] == ["fence", lines[1]] and lines[1].split()[:5] == ["method", "budget", "rays", "seconds", "MB"]
    assert lines[5].startswith("sparse, lens  5 rays ") and lines[5].endswith("32       6.00")  # left and right aligned
    assert summary([]) == ""


def read(scenes):
    return list(csv.DictReader(io.StringIO(as_csv(scenes)), strict=True))


def test_csv_has_every_figure_of_every_region():
    one = row("", 'a "renderer", quoted', 2, 5, 37.25)
    one.causes, one.peak_mb, one.unsteady = (45.5, 38.125), 12.5, (120, 7, 0.25)
    one.errors[0] |= {"psnr": math.inf, "nonfinite_image": 7}
    one.errors[2]["ssim"] = 0.1  # blurred
    found, = read([[one]])
    expected = {"renderer": 'a "renderer", quoted', "seconds": "2", "seconds_render": "1.5", "seconds_process": "0.5",
                "psnr_tonemapped": "37.25", "psnr": "inf", "nonfinite_image": "7", "blurred_ssim": "0.1",
                "silhouettes_max": "", "psnr_sampling": "45.5", "psnr_layers": "38.125", "peak_mb": "12.5",
                "pull_flickering_pixels": "120", "pull_sparkling_pixels": "7", "pull_largest": "0.25",
                "equal_error_seconds": ""}  # no ray tracing to compare with
    assert {name: found[name] for name in expected} == expected
    assert {prefix + name for name in FIGURES for prefix in ["", *(region + "_" for region in REGIONS)]} <= set(found)


def test_csv_compares_each_row_with_ray_tracing_of_its_scene():
    def scene(name, slower):
        rows = [row("traced", "traced", slower * one.total, one.rays, one.quality) for one in traced()]
        rows += [sparse(2, 5, 39), sparse(2, 5, 50)]
        for one in rows:
            one.scene = name
        return rows
    rows = read([scene("fence", 1), scene("grass", 2)])
    assert float(rows[3]["equal_error_seconds"]) == pytest.approx(8, abs=1e-9)
    assert float(rows[3]["equal_error_rays"]) == pytest.approx(32, abs=1e-9)
    assert float(rows[3]["equal_time_db"]) == pytest.approx(6, abs=1e-9)
    assert rows[4]["equal_error_seconds"] == ""  # beyond the measured range
    assert float(rows[8]["equal_error_seconds"]) == pytest.approx(16, abs=1e-9)


def test_times_given_with_the_pictures_have_no_peak():
    ready = row("", "ready", 2, 5, 37)
    ready.runs = 0
    assert read([[ready]])[0]["peak_mb"] == "" and read([[ready]])[0]["pull_largest"] == ""
    assert read([]) == []
