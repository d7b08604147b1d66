"""Steps that run once, as long as nothing that they depend on changes. The tools are shell scripts."""
import os
import resource
import subprocess
import time

import pytest
from steps import Failure, Runner, Step, StepList, run_process


class Tools:
    def __init__(self, folder):
        self.folder, self.report = folder, folder / "report"
        self.report.mkdir()
        self.tool("note", 'echo ran >>log; echo "$1" >"$2"')

    def tool(self, name, script):
        path = self.folder / "tools" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)

    def run(self, *steps, runs=1, enough=1000):
        for step in steps:
            step.seconds = None
        Runner(str(self.folder / "tools"), str(self.report), 2, runs, enough=enough).run_all(steps)
        return steps

    def noted(self):
        """How often the tool "note" has run since last asked."""
        log = self.report / "log"
        lines = log.read_text().splitlines() if log.exists() else []
        log.unlink(missing_ok=True)
        return len(lines)


@pytest.fixture
def tools(tmp_path):
    return Tools(tmp_path)


def noting(text, file, **more):
    return Step("steps of/" + file, [("warp", ["note", text, file])], outputs=[file], **more)


def tracing(seconds):
    """A shell script that writes a tracer's camera.json: the centre view took `seconds`."""
    return ('echo "{\\"focal_mm\\": 1, \\"sensor_width_mm\\": 1, \\"focus_distance\\": null, \\"lens_radius\\": 0, '
            f'\\"views\\": [], \\"view_spp\\": 1, \\"seconds\\": {{\\"center.exr\\": {seconds}}}}}" >views/camera.json')


def tracing_step():
    return Step("trace", [("render", ["trace"])], fresh="views", traced="views")


def test_what_is_done_is_not_run_again(tools):
    first, = tools.run(noting("a", "out"))
    assert tools.noted() == 1 and (tools.report / "out").read_text() == "a\n"
    assert first.seconds[2] > 0 and first.seconds[0] == 0 and first.peak_mb > 0
    second, = tools.run(noting("a", "out"))
    assert tools.noted() == 0
    assert (second.seconds, second.peak_mb, second.runs) == (first.seconds, first.peak_mb, 1)


def test_what_is_no_longer_the_same_is_run_again(tools):
    given = tools.folder / "given"
    given.write_text("1")
    step = noting("a", "out", given=[str(given)])

    def count(**more):
        tools.run(step, **more)
        return tools.noted()
    assert count() == 1
    given.write_text("22")
    assert count() == 1, "another input"
    step.commands[0][1][1] = "b"
    assert count() == 1, "another command"
    (tools.report / "out").unlink()
    assert count() == 1, "its output is gone"
    (tools.report / "steps/steps of/out.json").write_text('{"identity": 3')
    assert count() == 1, "a damaged record"
    tools.tool("note", 'echo ran >>log; echo "$1" >"$2" # rebuilt')
    assert count() == 1, "another program"
    assert count(runs=2) == 2, "more runs"
    assert count(runs=2) == 0


def test_what_reads_what_is_no_longer_the_same_is_run_again(tools):
    def run(text):
        first = noting(text, "first")
        tools.run(first, noting("b", "second", inputs=[first]), noting("c", "third"))
        return tools.noted()
    assert run("a") == 3 and run("changed") == 2


def test_it_goes_on_where_it_stopped(tools):
    def run():
        tools.run(noting("a", "first"), Step("broken", [("warp", ["broken", "x y"])]), noting("c", "third"))
    tools.tool("broken", "echo 'broken: no' >&2; echo 'broken: not at all' >&2; exit 3")
    with pytest.raises(Failure, match="broken x y --threads 2: exit code 3: broken: not at all"):
        run()
    assert tools.noted() == 1
    tools.tool("broken", "true")
    run()
    assert tools.noted() == 1


def test_times_are_medians_of_several_runs(tools):
    # Each run reports thousands of seconds of unneeded rendering, 3000 on average, which are subtracted.
    seconds = "$(case $(wc -l <log) in 1) echo 1000;; 2) echo 6000;; *) echo 2000;; esac)"
    tools.tool("trace", "echo ran >>log; " + tracing(seconds))
    begun = time.monotonic()
    step, = tools.run(tracing_step(), runs=3)
    assert tools.noted() == 3 and step.runs == 3
    assert -2000 <= step.seconds[0] <= -2000 + time.monotonic() - begun
    tools.run(noting("a", "untimed", timed=False), runs=3)
    assert tools.noted() == 1
    step, = tools.run(noting("a", "long enough"), runs=3, enough=1e-9)
    assert tools.noted() == 1 and step.runs == 1


def test_what_was_rendered_for_nothing_is_taken_off(tools):
    tools.tool("trace", "sleep 0.2; " + tracing("1000"))
    begun = time.monotonic()
    step, = tools.run(tracing_step())
    assert 0.2 - 1000 <= step.seconds[0] <= time.monotonic() - begun - 1000


def test_folders_are_emptied_before_and_scratch_is_gone_after(tools):
    tools.tool("make", '[ -z "$(ls kept)" ] || exit 1; touch kept/view_1.exr kept/view_0.exr')
    tools.tool("list", 'echo "$@" >listed')
    (tools.report / "kept").mkdir()
    (tools.report / "kept/view_9.exr").write_text("stale")
    commands = [("render", ["make"]), ("process", ["list", "a*b/c", "kept/view_*.exr", "none/*"])]
    tools.run(Step("make and list", commands, fresh="kept"))
    assert (tools.report / "listed").read_text() == "a*b/c kept/view_0.exr kept/view_1.exr --threads 2\n"
    assert (tools.report / "kept/view_0.exr").exists()
    tools.run(Step("scratch", commands, fresh="kept", scratch=True))
    assert not (tools.report / "kept").exists()


def test_a_step_of_a_name_is_kept_once():
    steps = StepList()
    first = steps.add(noting("a", "first"))
    assert steps.add(noting("b", "second")) is not first
    assert steps.add(noting("a", "first")) is first and len(steps) == 2


def test_file_names_need_no_quoting(tmp_path):
    name = "a 'quoted' $(name) \"\n;"
    run_process(["touch", name, "-"], tmp_path)
    assert (tmp_path / name).exists()


@pytest.mark.parametrize("command, says", [
    (["/no/such/program"], "/no/such/program: cannot be started"), (["false"], "exit code 1"),
    (["sh", "-c", "kill -9 $$"], "signal 9")])
def test_failures_of_programs_are_errors(tmp_path, command, says):
    with pytest.raises(Failure, match=says):
        run_process(command, tmp_path)


def test_a_run_tells_time_memory_and_output(tmp_path):
    assert run_process(["sleep", "0.1"], tmp_path)[0] >= 0.1
    assert run_process(["echo", "said"], tmp_path, subprocess.PIPE)[2] == b"said\n"
    # The memory of this process counts for its child too, until the child has started another program.
    mebibytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024 + 400
    little = run_process(["true"], tmp_path)[1]
    much = run_process(["dd", "if=/dev/zero", f"of={os.devnull}", f"bs={mebibytes}M", "count=1"], tmp_path)[1]
    assert much > mebibytes - 10 > little
