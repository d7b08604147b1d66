"""The rows of a scene, and the commands that make their pictures, without running any: dof-trace is a shell script that
knows one scene, focused at 5."""
import json

import pytest
from steps import Failure, StepList, UsageError
from systems import Budgets, open_scene, plan_rows

TRACE = """#!/bin/sh
[ "$1" = fence ] || exit 2
while [ "$1" != -o ]; do shift; done
echo '{"focal_mm": 50, "sensor_width_mm": 36, "focus_distance": 5, "lens_radius": 0.5, "views": [], "view_spp": 1,
       "seconds": {}}' >"$2/camera.json"
"""


class Planned:
    def __init__(self, scene, tools, quick):
        steps = StepList()
        self.scene = open_scene(str(scene), Budgets(), str(tools), steps)
        self.reference = self.scene.reference()
        self.rows = plan_rows(self.scene, Budgets(), quick, steps)
        self.steps = list(steps.values())

    def row(self, method, budget):
        return next(row for row in self.rows if (row.method, row.budget) == (method, budget))

    def count(self, renderer):
        return sum(row.renderer == renderer for row in self.rows)

    def methods(self):
        return {row.method for row in self.rows}


def commands(steps):
    return [" ".join(words) for step in steps for _, words in step.commands]


@pytest.fixture
def planned(tmp_path):
    (tmp_path / "tools").mkdir()
    trace = tmp_path / "tools/dof-trace"
    trace.write_text(TRACE)
    trace.chmod(0o755)

    def plan(scene, quick=False, planner=False):
        if planner:
            (tmp_path / "tools/ldi-plan").touch()
        return Planned(scene, tmp_path / "tools", quick)
    return plan


def test_the_whole_taxonomy_is_there(planned):
    every, quick = planned("fence"), planned("fence", quick=True)
    kinds = ["selective K=2", "selective K=4", "selective K=8", "lens draft", "lens normal", "lens final"]
    assert every.methods() == {
        "one view, scatter", "one view, gather", "one view, lens normal", "4 strata, layered blend",
        "4 strata, lens normal", "4 peeled layers, layered blend", "4 peeled layers, lens normal",
        "accumulated lens views", "distributed ray tracing", "centre + 4 at 2x, lens normal",
        "centre + 4 at 2x, lens final", *(f"centre + {n}, {kind}" for n in (4, 8) for kind in kinds)}
    # Four sample counts, five of rays and lens views; three of fine views.
    assert len(every.rows) == 4 * 7 + 5 + 5 + 4 * 12 + 3 * 2
    assert quick.methods() < every.methods() and len(quick.methods()) == 14


def test_steps_come_after_what_they_read(planned):
    every = planned("fence", planner=True)
    made = [output for step in every.steps for output in step.outputs]
    assert len({step.name for step in every.steps}) == len(every.steps) and len(set(made)) == len(made)
    for at, step in enumerate(every.steps):
        assert all(before in every.steps[:at] for before in step.inputs), step.name
    for row in every.rows:
        assert row.picture in made and (not row.many_points or row.many_points in made)
    assert every.scene.views(0, every.scene.samples[-1]).picture in made  # its depths define the regions


def test_a_row_takes_the_time_of_its_whole_chain(planned):
    every = planned("fence")

    def of(*names):
        return commands(every.row(*names).steps)
    views = " ".join(f"fence/views-5x16/view_{k}.exr" for k in range(4))
    assert of("centre + 4, lens final", "16 samples") == [
        "dof-trace fence --size 640x360 --spp 16 --views 4 -o fence/views-5x16",
        f"ldi-warp fence/views-5x16/center.exr {views} -o fence/views-5x16/warped.exr",
        "dof-gather fence/views-5x16/warped.exr --method lens --quality final -o fence/views-5x16/lens-final.exr"]
    first, second, *_ = of("centre + 8, selective K=2", "1 sample")
    assert first == "dof-trace fence --size 640x360 --spp 1 --views 8 -o fence/views-9x1" and second.startswith("ldi-w")
    # The same number of rays, in pixels of a quarter of the area.
    assert of("centre + 4 at 2x, lens final", "16 samples") == [
        "dof-trace fence --size 640x360 --spp 16 --views 4 --supersample 2 -o fence/fine-5x16",
        f"ldi-warp fence/fine-5x16/center.exr {views.replace('views-', 'fine-')} -o fence/fine-5x16/warped.exr",
        "dof-gather fence/fine-5x16/warped.exr --method lens --quality final --supersample 2 -o "
        "fence/fine-5x16/lens-final.exr"]
    assert every.row("centre + 4 at 2x, lens final", "16 samples").rays == 80
    assert of("4 peeled layers, layered blend", "4 samples") == [
        "dof-trace fence --size 640x360 --spp 4 --views 0 --deep peel:4 -o fence/peel-4x4",
        "dof-gather fence/peel-4x4/deep_peel.exr --method selective --layers 8 -o fence/peel-4x4/selective-8.exr"]
    assert of("distributed ray tracing", "64 rays") == [
        "dof-trace fence --size 640x360 --spp 1 --views 0 --reference 64 -o fence/traced-64"]
    # The picture for the comparison counts in no row's time.
    assert all(step.timed for row in every.rows for step in row.steps)


def test_pulls_of_focus_show_how_steady_the_lens_is(planned):
    """Only for the lens gather over centre and 4 with most samples, because a pull costs as much as 16 pictures."""
    every = planned("fence")
    frames = every.row("centre + 4, lens final", "64 samples").pull
    assert len(frames) == 16 and frames[-1] == "fence/views-5x64/pull-final.0016.exr"
    step, = [step for step in every.steps if step.name == "fence/views-5x64/pull-final"]
    assert commands([step]) == [
        "dof-gather fence/views-5x64/warped.exr --quality final -o fence/views-5x64/pull-final.####.exr "
        "--focus-distance 1:5,16:5.5 --frames 1-16"]
    assert not step.timed and sum(bool(row.pull) for row in every.rows) == 3


def test_rays_are_camera_samples_of_all_views(planned):
    every = planned("fence")
    for method, budget, rays, role in [
            ("one view, gather", "16 samples", 16, ""), ("centre + 4, lens normal", "16 samples", 80, "sparse"),
            ("centre + 4, selective K=8", "16 samples", 80, ""), ("centre + 8, lens normal", "1 sample", 9, "sparse"),
            ("4 strata, lens normal", "16 samples", 64, ""), ("accumulated lens views", "256 views", 4 * 256, ""),
            ("distributed ray tracing", "1024 rays", 1024, "traced")]:
        row = every.row(method, budget)
        assert (row.rays, row.role) == (rays, role), method


def test_noise_of_the_reference_is_its_own(planned):
    step, = planned("fence").reference.steps
    assert "--reference 4096 --seed 1" in commands([step])[0] and not step.timed


def test_planned_views_are_there_where_there_is_a_planner(planned):
    assert not planned("fence").count("centre + 4 planned")
    row = planned("fence", planner=True).row("centre + 4 planned, lens normal", "16 samples")
    assert (row.role, row.rays, row.partial_samples) == ("sparse", 16, 16)  # the partial views' rays are counted later
    text = "\n".join(commands(row.steps))
    assert "ldi-plan fence/views-1x16/center.exr --views 4 -o fence/planned-5x16/plan.json\n" in text
    assert "--plan fence/planned-5x16/plan.json" in text
    assert "ldi-warp fence/views-1x16/center.exr fence/planned-5x16/views/view_*.exr" in text


# --- Ready-made views: 8 with 64 samples per pixel, and in a folder inside 2 with 4 samples ---

def camera(points, samples, seconds, **more):
    return json.dumps({"width": 64, "height": 36, "focal_mm": 50.0, "sensor_width_mm": 36, "fstop": 0.5,
                       "focus_distance": 6, "lens_radius": 0.5, "views": points, "view_spp": samples, "ref_spp": 1024,
                       "seconds": seconds} | more)


@pytest.fixture
def yard(tmp_path):
    folder = tmp_path / "a yard"
    (folder / "few").mkdir(parents=True)
    (folder / "reference.exr").touch()
    (folder / "drt_16.exr").touch()
    seconds = {"center.exr": 20, "drt_16.exr": 2.5, "drt_4.exr": 0.5} | {f"view_{k}.exr": k for k in range(8)}
    (folder / "camera.json").write_text(camera([[k, 1] for k in range(8)], 64, seconds))
    few = {"center.exr": 1, "view_0.exr": 2, "view_1.exr": 3}
    (folder / "few/camera.json").write_text(camera([[1, 0], [-1, 0]], 4, few))
    return folder


def test_rows_are_what_the_views_allow(planned, yard):
    every = planned(yard, planner=True)
    assert every.scene.name == "a-yard"
    assert every.count("one view") == 6  # both sample counts
    assert every.count("centre + 4") == 6  # only with 64 samples
    assert every.count("centre + 8") == 6
    assert every.count("distributed ray tracing") == 1  # the other has a time but no picture
    for renderer in ["4 strata", "4 peeled layers", "accumulated lens views", "centre + 4 planned"]:
        assert every.count(renderer) == 0, renderer
    assert not any(command.startswith("dof-trace") for command in commands(every.steps))


def test_four_of_eight_views_are_every_second(planned, yard):
    every = planned(yard)
    row = every.row("centre + 4, lens normal", "64 samples")
    assert row.seconds[0] == 20 + 0 + 2 + 4 + 6 and row.rays == 320
    assert every.row("centre + 8, lens normal", "64 samples").seconds[0] == 20 + 28
    assert every.row("one view, gather", "4 samples").seconds[0] == 1
    assert every.row("distributed ray tracing", "16 rays").seconds[0] == 2.5
    views = " ".join(f"--view {k},0.5 {yard}/view_{2 * k}.exr" for k in range(4))
    lens = "--focal-length 50 --sensor-width 36 --lens-radius 0.5 --focus-distance 6"
    assert commands(row.steps)[0] == f"ldi-warp {yard}/center.exr {views} {lens} -o a-yard/views-5x64/warped.exr"
    assert row.steps[0].given == [f"{yard}/{name}.exr" for name in ["center", "view_0", "view_2", "view_4", "view_6"]]
    pull, = [step for step in every.steps if step.name == "a-yard/views-5x64/pull-normal"]
    assert commands([pull])[0].endswith("--focal-length 50 --sensor-width 36 --lens-radius 0.5 --focus-distance 1:6,16:"
                                        f"{1.1 * 6!r} --frames 1-16")


def test_finer_views_are_gathered_into_the_size_of_the_picture(planned, yard):
    assert not planned(yard).count("centre + 4 at 2x")
    (yard / "fine").mkdir()
    seconds = {"center.exr": 9} | {f"view_{k}.exr": 1 for k in range(4)}
    (yard / "fine/camera.json").write_text(camera([[1, 0], [0, 1], [-1, 0], [0, -1]], 16, seconds, supersample=2))
    every = planned(yard)
    row = every.row("centre + 4 at 2x, lens normal", "16 samples")
    assert (row.rays, row.seconds[0], row.role) == (80, 13, "sparse")
    text = "\n".join(commands(row.steps))
    assert "/fine-5x16/warped.exr --method lens --quality normal --supersample 2 " in text
    assert text.count("--supersample") == 1
    assert "--supersample" not in "\n".join(commands(every.row("centre + 4, lens normal", "64 samples").steps))


def test_pictures_of_other_ways_are_rows_with_their_pulls(planned, yard):
    other = {"file": "by_them.exr", "renderer": "one view", "processor": "theirs", "budget": "64 samples", "rays": 64}

    def write(**seconds):
        seconds = {name + ".exr": value for name, value in seconds.items()}
        (yard / "camera.json").write_text(camera([[1, 0]], 64, seconds, others=[other]))
    write(center=20, view_0=1, drt_16=2.5, by_them=21)
    for frame in ["drt_16.pull.0001.exr", "drt_16.pull.0002.exr", "by_them.pull.0001.exr"]:
        (yard / frame).touch()
    every = planned(yard)
    row = every.row("one view, theirs", "64 samples")
    assert (row.seconds[0], row.rays, row.role, row.picture) == (21, 64, "", f"{yard}/by_them.exr")
    assert row.pull == [f"{yard}/by_them.pull.0001.exr"]
    assert len(every.row("distributed ray tracing", "16 rays").pull) == 2
    assert not every.row("one view, gather", "64 samples").pull
    write(center=20, view_0=1)
    with pytest.raises(Failure, match="camera.json: no seconds of by_them.exr"):
        planned(yard)


def test_what_a_denoiser_made_has_its_own_rows(planned, yard):
    without = planned(yard)
    assert not without.count("denoised ray tracing") and not without.count("centre + 4 denoised")
    seconds = {"center.exr": 20, "drt_16.exr": 2.5} | {f"view_{k}.exr": k for k in range(4)}
    for name in ["center", "view_0", "view_1", "view_2", "view_3", "drt_16"]:
        (yard / f"{name}.denoised.exr").touch()
        seconds[f"{name}.denoised.exr"] = 30
    (yard / "camera.json").write_text(camera([[k, 1] for k in range(4)], 64, seconds))
    every = planned(yard)
    views = every.row("centre + 4 denoised, lens normal", "64 samples")
    assert (views.seconds[0], views.rays, views.role) == (5 * 30, 320, "")
    text = "\n".join(commands(views.steps))
    assert "view_3.denoised.exr" in text and "-o a-yard/views-denoised-5x64/warped.exr" in text
    assert every.row("centre + 4, lens normal", "64 samples").seconds[0] == 20 + 0 + 1 + 2 + 3
    traced = every.row("denoised ray tracing", "16 rays")
    assert (traced.seconds[0], traced.role, traced.picture) == (30, "", f"{yard}/drt_16.denoised.exr")


def test_what_is_missing_is_named(planned, yard):
    for text in ['{"width": 64', '{"width": "wide"}']:
        (yard / "few/camera.json").write_text(text)
        with pytest.raises(Failure, match="few/camera.json"):
            planned(yard)
    (yard / "few/camera.json").unlink()
    (yard / "reference.exr").unlink()
    with pytest.raises(Failure, match="reference.exr"):
        planned(yard)
    with pytest.raises(UsageError, match="nowhere"):
        planned(yard.parent / "nowhere")
