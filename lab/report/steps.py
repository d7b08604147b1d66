"""The work behind a report: steps that run tools one at a time, each after the steps whose files it reads. Each is
recorded, so that a report continues where it stopped.

The record of a step (steps/NAME.json in the folder of the report) holds its commands, the contents of the programs, the
records of its inputs, and the sizes and times of its given files. While these are unchanged and its outputs exist, the
step is not run again. A damaged record counts as missing.
"""
import dataclasses
import functools
import glob
import hashlib
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from rows import STAGES


class Failure(Exception):
    """A failure of input or of a tool; the message names it. A second argument is the tool's exit code."""


class UsageError(Exception):
    """An argument is wrong; the message names it."""


@dataclasses.dataclass(eq=False)
class Step:
    name: str  # unique, fit for a file name; may hold /
    # (stage, words): a program in the folder of the tools, and arguments; paths are relative to the report's folder.
    commands: list
    inputs: list = ()  # earlier steps
    given: list = ()  # input files that no step makes
    outputs: list = ()  # files that exist afterwards
    fresh: str = ""  # a folder that is emptied first
    scratch: bool = False  # that folder is needed only between the commands
    traced: str = ""  # dof-trace rendered a centre view into this folder unasked: its seconds are subtracted
    timed: bool = True  # False: run once, because its time is not needed
    weight: float = 1  # estimated seconds, only for the displayed time left
    # When it has run: seconds of each stage, as medians; memory; how many runs.
    identity: str = ""
    seconds: list = None
    peak_mb: float = 0
    runs: int = 0


class StepList(dict):
    def add(self, step):
        """Returns the step; a step of the same name is kept once."""
        return self.setdefault(step.name, step)


def matching(pattern, folder=None):
    """The files whose names match the pattern with a * in its last part, in order."""
    head, tail = os.path.split(pattern)
    return sorted(glob.glob(os.path.join(glob.escape(head), tail), root_dir=folder))


def read_camera(folder):
    """camera.json, which accompanies the pictures of dof-trace and ready-made ones. Infinity is null there."""
    path = os.path.join(folder, "camera.json")
    with open(path) as file:
        try:
            camera = {"supersample": 1, "others": []} | json.load(file)
            for key in ["focal_mm", "sensor_width_mm", "focus_distance", "lens_radius"]:
                camera[key] = math.inf if camera[key] is None else float(camera[key])
            camera["views"] = [(float(x), float(y)) for x, y in camera["views"]]  # lens points, in the unit disc
            camera["seconds"] = {name: float(seconds) for name, seconds in camera["seconds"].items()}
            camera["view_spp"] = int(camera["view_spp"])
            names = ["file", "renderer", "processor", "budget", "rays"]
            camera["others"] = [[other[name] for name in names] for other in camera["others"]]
            return camera
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            raise Failure(f"{path}: {'no ' if isinstance(error, KeyError) else ''}{error}")


def run_process(command, folder, stdout=subprocess.DEVNULL):
    """Runs the command and returns (wall seconds, largest resident memory in MiB, output). The kernel counts the
    caller's resident memory in the child's, so callers should stay small while they measure."""
    shown = f"{' '.join(command):.300}"
    with tempfile.TemporaryFile() as said:
        begun = time.monotonic()
        try:
            child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=stdout, stderr=said)
        except OSError as error:
            raise Failure(f"{shown}: cannot be started: {error.strerror}")
        output = child.stdout.read() if child.stdout else b""
        _, status, used = os.wait4(child.pid, 0)
        seconds = time.monotonic() - begun
        child.returncode = code = os.waitstatus_to_exitcode(status)
        said.seek(0)
        last = said.read().decode(errors="replace").rstrip("\n").replace("\r", "\n").rpartition("\n")[2]
    if code:
        raise Failure(f"{shown}: " + (f"exit code {code}: {last}" if code > 0 else f"ended by signal {-code}"), code)
    return seconds, used.ru_maxrss / 1024, output


def write_file(path, text):
    """Creates the folder if it is missing. The file appears complete or not at all."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    pathlib.Path(path + ".new").write_text(text)
    os.replace(path + ".new", path)


class TimeLeft:
    """A line on a terminal with the current step, the number of steps and the time left. Prints nothing elsewhere."""

    def __init__(self, weights):
        self.begun, self.left, self.done, self.step, self.steps = time.monotonic(), sum(weights), 0, 0, len(weights)

    def show(self, text=""):
        if sys.stderr.isatty():
            print("\r\033[K" + text, end="", file=sys.stderr, flush=True)

    def begin(self, what, weight=1):
        self.step += 1
        scale = (time.monotonic() - self.begun) / self.done if self.done else 1
        minutes, seconds = divmod(int(self.left * scale), 60)
        self.show(f"dof-report: {self.step} of {self.steps}, {minutes}:{seconds:02} left: {what}")
        self.left, self.done = self.left - weight, self.done + weight


@dataclasses.dataclass(eq=False)
class Runner:
    tools: str  # folder of the programs
    folder: str  # folder of the report
    threads: int = 0  # for every program
    runs: int = 3  # of a timed step; its times are medians
    max_memory: str = ""  # of every program, for reading a file
    enough: float = 3  # seconds; a step is not run again after this total
    verbose: bool = False

    def path(self, file):
        return os.path.join(self.folder, file)

    def run_tool(self, words, threads, **more):
        """A word that has a * in its last part stands for the matching files."""
        files = [file for word in words[1:]
                 for file in (matching(word, self.folder) if "*" in os.path.basename(word) else [word])]
        limit = ["--max-memory", self.max_memory] if self.max_memory else []
        command = [os.path.join(self.tools, words[0]), *files, "--threads", str(threads), *limit]
        return run_process(command, self.folder, **more)

    @functools.cache
    def program(self, name):
        return hashlib.sha256(pathlib.Path(self.tools, name).read_bytes()).hexdigest()

    def identify(self, step):
        """Equal if and only if running the step again would give the same result."""
        given = [(file, (stat := os.stat(file)).st_size, stat.st_mtime_ns) for file in step.given]
        what = [self.threads, [[self.program(words[0]), words] for _, words in step.commands],
                [before.identity for before in step.inputs], given, self.runs if step.timed else 0]
        return hashlib.sha256(json.dumps(what).encode()).hexdigest()

    def record(self, step):
        return self.path(f"steps/{step.name}.json")

    def is_done(self, step):
        try:
            record = json.loads(pathlib.Path(self.record(step)).read_text())
            step.seconds, step.peak_mb, step.runs = record["seconds"], record["peak_mb"], record["runs"]
            return record["identity"] == step.identity and all(os.path.exists(self.path(file)) for file in step.outputs)
        except (OSError, ValueError, TypeError, KeyError):
            return False  # none, written by another version, or left by an interrupted run

    def once(self, step):
        seconds, peak_mb = [0.0] * len(STAGES), 0
        for stage, words in step.commands:
            took, memory, _ = self.run_tool(words, self.threads)
            seconds[STAGES.index(stage)] += took
            peak_mb = max(peak_mb, memory)
        if step.traced:
            seconds[0] -= read_camera(self.path(step.traced))["seconds"].get("center.exr", 0)
        return seconds, peak_mb

    def run(self, step):
        write_file(self.record(step), "")
        for file in step.outputs:
            os.makedirs(os.path.dirname(self.path(file)), exist_ok=True)
        if step.fresh:
            shutil.rmtree(self.path(step.fresh), ignore_errors=True)
            os.makedirs(self.path(step.fresh))
        done = []
        while not done or step.timed and len(done) < self.runs and sum(sum(run[0]) for run in done) < self.enough:
            done.append(self.once(step))
        if step.scratch:
            shutil.rmtree(self.path(step.fresh))
        step.seconds = [statistics.median(times) for times in zip(*(seconds for seconds, _ in done))]
        step.peak_mb, step.runs = statistics.median(memory for _, memory in done), len(done)
        record = {"identity": step.identity, "commands": [" ".join(words) for _, words in step.commands],
                  "seconds": step.seconds, "peak_mb": step.peak_mb, "runs": step.runs}
        write_file(self.record(step), json.dumps(record, indent=1) + "\n")

    def run_all(self, steps):
        waiting = []
        for step in steps:
            step.identity = self.identify(step)
            waiting += [] if self.is_done(step) else [step]
        left = TimeLeft([step.weight for step in waiting])
        for step in waiting:
            left.begin(step.name, step.weight)
            if self.verbose:
                print("dof-report: " + step.name, file=sys.stderr)
            self.run(step)
        left.show()
