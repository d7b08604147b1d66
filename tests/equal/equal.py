"""The same picture in another file: each tool (DOORS) against each change of its files (CHANGES) that must not change what
it makes, or changes it by a known rule.

    equal.py BIN_DIR [--python MODULE_DIR] [--slow] [--only DOOR,CHANGE] [--keep FOLDER]

Prints each wrong cell of the table, with the command that repeats it. `--keep` leaves the files there, and prints all
commands. Cells to which a change does not apply are in NEVER, with the reason. --slow: the cells of SLOW; else the others.
"""
import argparse
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import threading

import numpy

import heif
import own_depth
import scene
from pictures import SKY, Photo, Picture, exr, is_depth, pfm, png, read_exr, tiff

SECONDS = int(os.environ.get("SPARSELENS_HOSTILE_SECONDS", 60))  # that a command may take
FRAMES = ["-003", "-002", "-001"]
ENVIRONMENT = {**os.environ, "SPARSELENS_NO_HISTORY": "1", "PYTHONDONTWRITEBYTECODE": "1"}


class Wrong(Exception):
    pass


@dataclasses.dataclass
class Inputs:
    """What a command gets: pictures by their role, the lens and other options, and how the files are written and named."""
    files: dict
    lens: dict
    more: tuple = ()
    name: str = "{}"
    through: str = "files"  # or stdin, fifo, frames
    picture: callable = exr  # picture(path, Picture)
    photo: callable = lambda photo: (png, ".png") if photo.own is None else (own_jpeg("gdepth"), ".jpg")  # how a Photo is written: write(path, Photo), and the ending

    def but(self, **fields):
        return dataclasses.replace(self, **fields)

    def each(self, change, kind=Picture):
        """change(picture) makes each picture of that kind anew."""
        return self.but(files={role: [change(p) if isinstance(p, kind) else p for p in files] for role, files in self.files.items()})

    def write(self, folder):
        """Writes all files; their names by role."""
        names = {}
        for role, pictures in self.files.items():
            names[role] = []
            for k, picture in enumerate(pictures):
                write, ending = (self.picture, ".exr") if isinstance(picture, Picture) else self.photo(picture)
                names[role].append(self.name.format(f"{role}{k}") + ending)
                for frame in FRAMES if self.through == "frames" else [""]:
                    write(folder / names[role][-1].replace("####", frame), picture)
        return names


# ---- The doors ----
@dataclasses.dataclass
class Door:
    """words(names, inputs, made): the command. `made`: what it writes; read by the reader of its ending."""
    files: callable
    words: callable
    made: tuple = ("out.exr",)
    kind: str = "tool"


def tool(name, words=lambda f: f["in"], more=(), lens=True):
    """The words of a tool; `words` of the names by role, `more` with the files that it makes, as {1}."""
    def command(names, inputs, made):
        given = [word for option, value in inputs.lens.items() for word in (f"--{option}", str(value))] if lens else []
        frames = [f"--frames={int(FRAMES[0])}-{int(FRAMES[-1])}"] if inputs.through == "frames" else []
        return [str(BENCH.bin / name), *words(names), *frames, *(word.format(*made) for word in more), *given, *inputs.more, "--threads", "1"] + \
            (["-o", made[0]] if made[0] != "stdout" else [])
    return command


def asks_pipe(names, inputs, _):
    said = dict(zip(inputs.more[::2], inputs.more[1::2]))
    settings = {option.removeprefix("--"): str(value) for option, value in [*inputs.lens.items(), *said.items(), ("lens-samples", POINTS)]}
    request = {"ask": "picture", "file": names["in"][0], "settings": settings, **({"frame": -2} if inputs.through == "frames" else {})}
    return ["bash", "-c", f'echo "$1" | {shlex.quote(str(BENCH.bin / "dof-view"))} --pipe 3<>pixels', "-", json.dumps(request)]


PYTHON_SCRIPT = """import json, sys, sparselens
files, lens, more, made = json.loads(sys.argv[1])
lens = {k.replace("-", "_"): v for k, v in lens.items()}
more = {k[2:].replace("-", "_"): float(v) if v[:1].isdigit() else v for k, v in zip(more[::2], more[1::2])}
views = [sparselens.open_view(name, **more, **lens) for name in files]
sparselens.write(made, sparselens.gather(sparselens.warp(views, **lens), **lens), type="float", compression="zip")"""


def asks_python(names, inputs, made):
    return [sys.executable, "-c", PYTHON_SCRIPT, json.dumps([names["in"] + names["rim"], inputs.lens, inputs.more, made[0]])]


def views():
    return {"in": [scene.view()], "rim": [scene.view(at) for at in scene.RIM]}


def photos():
    """A photograph of the scene on a grey ground, and its disparity."""
    picture = scene.view()
    light = numpy.stack([picture.channels[c] + 0.2 * (1 - picture.channels["A"]) for c in "RGB"], 2)
    return {"in": [Photo((255 * light.clip(0, 1) ** (1 / 2.2)).round().astype("u1"))],
            "depth": [Photo((255 * (2.5 / picture.channels["Z"].clip(0, 12))).round().astype("u1"))]}


def coarse_photos():
    """The same with a depth of half its width and height."""
    files = photos()
    return {**files, "depth": [Photo(files["depth"][0].values[::2, ::2])]}


def own_photos():
    """The same with the depth in the photograph itself."""
    files = photos()
    return {"in": [Photo(files["in"][0].values, files["depth"][0].values)]}


def linear(photo):
    """The same photograph as light."""
    v = photo.values / 255
    light = numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4).astype("<f4")
    return Picture({name: light[:, :, k] for k, name in enumerate("RGB")}, scene.DISPLAY, scene.DISPLAY)


def smooth(picture):
    """As a denoiser would leave its colours: here the mean of three in a row."""
    def mean(_, v):
        wide = numpy.pad(v, ((0, 0), (1, 1)), "edge")
        return scene.half((wide[:, :-2] + wide[:, 1:-1] + wide[:, 2:]) / 3)
    return picture.but(channels={name: picture.channels[name] for name in "RGB"}).each(mean)


def made_of(door, lens=None):
    return BENCH.once(door, lens)[0][0]["out.exr"]


def gathered():
    """A gathered picture with a mistake, which the rays mend."""
    picture = made_of("gather-ldi").windowed(scene.DISPLAY)
    values = {name: scene.half(v) if v.dtype == "<f4" else v for name, v in picture.channels.items()}
    values["R"][10:20, 12:30] *= 1.25
    return picture.but(channels=values, attributes={})


def to_finish():
    return {"in": [gathered()], "rays": [scene.rays(1), scene.rays(2)]}


def to_denoise(files):
    return {**files, "denoised": [smooth(p) for role in files for p in files[role] if role != "in" or "rim" in files]}


POINTS = "1024"  # so many lens points that their pattern shows little
FLOAT, ZIPS, DEPTH = ("-d", "float", "--compression", "zip"), ("--compression", "zips"), ("out.exr", "depth.exr")
WITH_DEPTH, RAYS = (*FLOAT, "--depth-out", "{1}", "--lens-samples", POINTS), lambda f: f["in"] + f["rays"]
PHOTO = ("--blur", "4", "--focus-distance", "2", "--lens-samples", POINTS, "--depth-file")
DOORS = {
    "gather-view": Door(lambda: {"in": [scene.view()]}, tool("dof-gather", more=WITH_DEPTH), DEPTH, "flat"),
    "gather-deep": Door(lambda: {"in": [scene.deep()]}, tool("dof-gather", more=WITH_DEPTH), DEPTH, "deep"),
    "gather-ldi": Door(lambda: {"in": [made_of("warp")]}, tool("dof-gather", more=WITH_DEPTH), DEPTH, "deep"),
    "gather-selective": Door(lambda: {"in": [made_of("warp")]}, tool("dof-gather", more=(*FLOAT, "--method", "selective")), kind="deep"),
    "gather-photo": Door(photos, tool("dof-gather", lambda f: [*f["in"], *PHOTO, *f["depth"]], FLOAT, lens=False), kind="photo"),
    "gather-photo-coarse": Door(coarse_photos, tool("dof-gather", lambda f: [*f["in"], *PHOTO, *f["depth"]], FLOAT, lens=False), kind="photo"),
    "gather-photo-own": Door(own_photos, tool("dof-gather", lambda f: [*f["in"], *PHOTO[:-1]], FLOAT, lens=False), kind="photo"),
    "gather-photo-exr": Door(lambda: {"in": [linear(photos()["in"][0])], "depth": photos()["depth"]},
                             tool("dof-gather", lambda f: [*f["in"], *PHOTO, *f["depth"]], FLOAT, lens=False), kind="photo"),
    "gather-depth-file": Door(lambda: {"in": [scene.view().only("RGBA")], "depth": [scene.view().only("Z")]},
                              tool("dof-gather", lambda f: [*f["in"], "--depth-file", *f["depth"]], WITH_DEPTH), DEPTH, "flat"),
    "warp": Door(views, tool("ldi-warp", lambda f: f["in"] + f["rim"], ZIPS), kind="views"),
    "warp-denoised": Door(lambda: to_denoise(views()), tool("ldi-warp", lambda f: [*f["in"], *f["rim"], "--denoised", *f["denoised"]], ZIPS),
                          kind="views"),
    "cluster": Door(lambda: {"in": [made_of("warp")]}, tool("ldi-cluster", more=(*ZIPS, "--tolerance", "0.5")), kind="deep"),
    "merge": Door(lambda: {"in": [scene.deep(scene.THINGS[::2]), scene.deep(scene.THINGS[1::2])]}, tool("ldi-cluster", more=ZIPS), kind="two deep"),
    "plan": Door(lambda: {"in": [scene.view()]}, tool("ldi-plan", more=("--noise", "0")), ("plan.json",), "flat"),
    "finish": Door(to_finish, tool("dof-finish", RAYS, FLOAT, False), kind="finish"),
    "finish-denoised": Door(lambda: to_denoise(to_finish()),
                            tool("dof-finish", lambda f: [*RAYS(f), "--denoised", *f["denoised"]], FLOAT, False), kind="finish"),
    "finish-ask": Door(to_finish, tool("dof-finish", RAYS, (*FLOAT, "--ask", "{1}", "--rays", "80", "--samples", "16,16"), False),
                       ("out.exr", "mask.exr"), "finish"),
    "match": Door(lambda: {"in": [scene.texture()], "plate": [made_of("plate", {"focus-distance": 6})]},
                  tool("dof-match", lambda f: [*f["in"], *f["plate"], "--fit", "focus"]), ("keys.json",), "match"),
    "compare": Door(lambda: {"in": [scene.rays(1), scene.rays(2)]}, tool("dof-compare", more=["--json"], lens=False), ("stdout",), "compare"),
    "pipe": Door(lambda: {"in": [scene.view()]}, asks_pipe, ("stdout",), "flat"),
    "python": Door(views, asks_python, kind="views"),
}

MAKERS = {"plate": Door(lambda: {"in": [scene.texture()]}, tool("dof-gather", more=(*FLOAT, "--overscan", "keep")))}  # of files for doors


# ---- Reading what they make ----
def rectangles(path):
    """A plan: which pixels of each view it renders."""
    plan = json.loads(path.read_text())
    left, top, right, bottom = data = tuple(plan["data_window"])
    channels = {}
    for each in plan["views"]:
        channels[each["name"]] = drawn = numpy.zeros((bottom - top + 1, right - left + 1), "<f4")
        for box in each["rectangles"]:
            drawn[box[1] - top:box[3] - top + 1, box[0] - left:box[2] - left + 1] = 1
    return Picture(channels, data, tuple(plan["display_window"]))


def said(path):
    """What is printed: figures, or the answer of a pipe with its pixels."""
    lines = path.read_text()
    if not lines.startswith("200"):
        return figures(json.loads(lines))
    status, size, answer = lines.splitlines()[1].split(" ", 2)
    if status != "200":
        raise Wrong(answer)
    answer = json.loads(answer)
    box = answer["data"]
    types = {channel["name"]: {"half": "<f2", "float": "<f4", "uint": "<u4"}[channel["type"]] for channel in answer["channels"]}
    values = numpy.frombuffer((path.parent / "pixels").read_bytes()[:int(size)], list(types.items()))
    return Picture({name: values[name].reshape(box[3] - box[1] + 1, -1) for name in values.dtype.names}, tuple(box), tuple(answer["display"]))


def figures(value, name=""):
    """All numbers, by their path."""
    if isinstance(value, (dict, list)):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        return {key: number for k, v in items for key, number in figures(v, f"{name}.{k}" if name else str(k)).items()}
    return {name: value} if isinstance(value, (int, float)) else {}


READ = {".exr": read_exr, "plan.json": rectangles, "keys.json": lambda path: figures(json.loads(path.read_text())), "stdout": said}


class Bench:
    """Runs commands, in a folder for each cell."""
    def __init__(self, bin_dir, folder, prints):
        self.bin, self.folder, self.prints, self.known, self.locks, self.lock = bin_dir, folder, prints, {}, {}, threading.Lock()

    def once(self, name, lens=None, inputs=None, files=False, change=""):
        """Made once: the plain files of a door; what it makes of them, for other doors; what it makes of `inputs`."""
        door, first = (DOORS | MAKERS)[name], CHANGES[change].first if change else None
        key = (name, str(lens), files, first)
        with self.lock:
            mine = self.locks.setdefault(key, threading.RLock())
        with mine:
            if key not in self.known:
                if files:
                    self.known[key] = door.files()
                else:
                    folder = self.folder / name / (f"before {change}" if inputs else f"for others {lens or ''}")
                    inputs = inputs or Inputs(self.once(name, files=True), {**scene.LENS, **(lens or {})})
                    self.known[key] = self.make(door, inputs, folder)
            return self.known[key]

    def make(self, door, inputs, folder):
        """What the door makes of the inputs: for each frame, pictures or figures by the name of the file."""
        folder.mkdir(parents=True)
        names = inputs.write(folder)
        frames = FRAMES if inputs.through == "frames" else [""]
        made = [name if inputs.through != "frames" else name.replace(".", ".####.") for name in door.made]
        first, every, before, after = names["in"][0], sum(names.values(), []), "", ""
        printed = "stdout"
        words = door.words(names, inputs, made)
        if inputs.through == "stdin":
            printed = made[0] if made[0] != "keys.json" else "stdout"  # dof-match prints a table besides
            words, after = ["-" if word in (first, printed) else word for word in words], f" <{shlex.quote(first)}"
        if inputs.through == "fifo":
            before = "".join(f"mv {q} {q}.bytes; mkfifo {q}; cat {q}.bytes >{q} & " for q in map(shlex.quote, every))
        command = f"{before}{shlex.join(words)}{after} >{shlex.quote(printed)}"
        if self.prints:
            print(f"cd {shlex.quote(str(folder))} && {command}", file=sys.stderr)
        ran = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, timeout=SECONDS, env=ENVIRONMENT)
        if ran.returncode != 0:
            raise Wrong(f"exit {ran.returncode}: {ran.stderr.strip()[:300]}")
        signature = words, [(folder / name).read_bytes() for name in every if (folder / name).is_file()], inputs.through
        return [{name: READ[name if name in READ else name[-4:]](folder / now.replace("####", frame)) for name, now in zip(door.made, made)}
                for frame in frames], signature


# ---- The changes ----
@dataclasses.dataclass
class Change:
    """`change` makes the inputs anew. `undo` makes what a door made of the old ones of what it makes of the new ones, within
    `bound`; figures are multiplied by those of `figures`, None: not compared. `first` is done to old and new inputs."""
    change: callable
    undo: callable = lambda picture: picture
    bound: float = 0
    first: callable = lambda inputs: inputs
    needs: str = "an EXR file"  # a key of NEEDS
    figures: dict = dataclasses.field(default_factory=dict)
    without: tuple = ()  # channels that are not compared


NEEDS = {"an EXR file": lambda p: isinstance(p, Picture), "a flat depth": lambda p: isinstance(p, Picture) and p.counts is None and "Z" in p.channels,
         "a photograph": lambda p: isinstance(p, Photo) and p.own is None,
         "a depth of its own": lambda p: isinstance(p, Photo) and p.own is not None, "a file": lambda p: True, "an id": lambda p: isinstance(p, Picture) and "IndexOB.X" in p.channels,
         "a depth": lambda p: isinstance(p, Picture) and any(map(is_depth, p.channels))}


def pictures(change):
    return lambda inputs: inputs.each(change)


def in_turn(*changes):
    def change(inputs):
        for each in changes:
            inputs = each(inputs)
        return inputs
    return change


def written(**form):
    return lambda inputs: inputs.but(picture=lambda path, picture: exr(path, picture, **form))


def in_parts(inputs):
    """Colours, depth and each layer in a part of their own; deep layers with the depths of their samples."""
    def write(path, picture):
        groups = {}
        for name in picture.channels:
            layer = name.split(".")[0] if "." in name and not name.startswith("ldi.") else "rgba"
            groups.setdefault("depth" if picture.counts is None and is_depth(name) else layer, []).append(name)
        if picture.counts is not None:
            groups = {part: names if part == "rgba" else names + [n for n in ("Z", "ZBack") if n in picture.channels] for part, names in groups.items()}
        exr(path, *(picture.but(channels={n: picture.channels[n] for n in names}) for names in reversed(groups.values())), names=list(reversed(groups)))
    return inputs.but(picture=write)


def prefixed(picture):
    layer = {**{c: f"ViewLayer.Combined.{c}" for c in "RGBA"}, "Z": "ViewLayer.Depth.Z", "ZBack": "ViewLayer.Depth.ZBack"}
    return picture.renamed(lambda name: layer.get(name, name if name.startswith("ldi.") else f"ViewLayer.{name}"))


def unprefixed(picture):
    return picture.renamed(lambda name: name.removeprefix("ViewLayer.").removeprefix("Combined.").removeprefix("Depth."))


def shifted(dx, dy):
    return lambda picture: picture.boxes(lambda b: (b[0] + dx, b[1] + dy, b[2] + dx, b[3] + dy))


def cut(inputs):
    """Each file without the rows and columns at its border that hold nothing."""
    def box(picture):
        values = [v for name, v in picture.channels.items() if name in "RGBA"] or [picture.channels["Z"] < SKY]
        y, x = numpy.nonzero(picture.counts if picture.counts is not None else sum(v != 0 for v in values))
        left, top = picture.data[:2]
        return left + x.min(), top + y.min(), left + x.max(), top + y.max()
    boxes = {role: [box(p) for p in files if isinstance(p, Picture)] for role, files in inputs.files.items()}
    if "denoised" in boxes:  # what is finished together is cut alike
        every = [tuple(f(side) for f, side in zip((min, min, max, max), zip(*sum(boxes.values(), []))))]
        boxes = {role: every * len(files) for role, files in boxes.items()}
    return inputs.but(files={role: [p.windowed(b) for p, b in zip(files, boxes[role])] if boxes[role] else files for role, files in inputs.files.items()})


def grown(picture):
    left, top, right, bottom = picture.data
    return picture.windowed((left - 5, top - 3, right + 9, bottom + 8))


def as_half(picture):
    """Channels whose values are halves, as halves; the sky is the largest half."""
    def change(name, v):
        small = v.clip(None, 65504).astype("<f2")
        return small if v.dtype == "<f4" and ((small == v) | (v >= SKY)).all() else v
    return picture.each(change)


def scaled(which, factor):
    return lambda picture: picture.each(lambda name, v: numpy.where(v >= SKY, v, v * v.dtype.type(factor)) if which(name) else v)


def is_light(name):
    return name in "RGB" or name.startswith("diffuse")


def is_distance(name):
    return is_depth(name) or name in ("ZBack", "ldi.optical")


def placed(change):
    """change(x, y) makes the position of each view anew."""
    def at(picture):
        if "worldToCamera" not in picture.attributes:
            return picture
        matrix = numpy.frombuffer(picture.attributes["worldToCamera"][1], "<f4").reshape(4, 4).copy()
        matrix[3, :2] = [-v for v in change(*-matrix[3, :2])]
        return picture.but(attributes={**picture.attributes, "worldToCamera": ("m44f", matrix.tobytes())})
    return at


def larger(factor, lens):
    """All distances times the factor; options of the lens by their own."""
    return in_turn(pictures(scaled(is_distance, factor)), pictures(placed(lambda x, y: (factor * x, factor * y))),
                   pictures(lambda p: p.each(lambda name, v: v / v.dtype.type(factor) if name == "ldi.solid" else v)),
                   lambda inputs: inputs.but(lens={name: value * lens.get(name, 1) for name, value in inputs.lens.items()}))


def by_fstop(inputs):
    lens = {name: value for name, value in inputs.lens.items() if name != "lens-radius"}
    return inputs.but(lens={**lens, "fstop": 0.05 / (2 * scene.RADIUS), "scene-unit": 1}) if inputs.lens else inputs


def backwards(inputs):
    files = {role: pictures[::-1] for role, pictures in inputs.files.items()}
    if "rim" in files and "denoised" in files:  # the centre view's stays the first
        files["denoised"] = files["denoised"][-1:] + files["denoised"][:-1]
    if "plate" in files or "depth" in files:
        raise Wrong("not several of a kind")
    return inputs.but(files=files)


def brighter(picture):
    """A control: in one place the light is another, and the door must tell."""
    def change(name, v):
        w = v.copy()
        w[numpy.unravel_index(v.size * 48 // 100, v.shape)] += 1
        return w if name in "GZ" else v
    return picture.each(change)


def depth_as(kind, value, *more):
    """The planar depth stored in another way: value(z, picture)."""
    def change(picture):
        return picture.each(lambda name, z: value(z.astype(float), picture).astype("<f4") if is_depth(name) else z)
    return in_turn(pictures(change), lambda inputs: inputs.but(more=(*inputs.more, "--depth", kind, *more)))


def along_rays(z, picture):
    height, width = z.shape
    y, x = numpy.mgrid[0:height, 0:width] + 0.5
    return numpy.where(z >= SKY, z, z * numpy.sqrt(1 + ((x - width / 2) ** 2 + (y - height / 2) ** 2) * (36 / 50 / width) ** 2))


def photo_as(write, ending, **form):
    return lambda inputs: inputs.but(photo=lambda _: (lambda path, photo: write(path, photo, **form), ending))


def of_depths(change):
    """change(photo) for the grey ones."""
    return lambda inputs: inputs.each(lambda photo: change(photo) if photo.values.ndim == 2 else photo, Photo)


def fractions(photo):
    return Photo((photo.values / 255).astype("<f4"))


def depth_as_pfm(order):
    return in_turn(of_depths(fractions), lambda inputs: inputs.but(
        photo=lambda photo: (lambda path, photo: pfm(path, photo, order), ".pfm") if photo.values.ndim == 2 else (png, ".png")))


def depth_as_exr(inputs):
    def as_exr(photo):
        frame = (0, 0, photo.values.shape[1] - 1, photo.values.shape[0] - 1)
        return Picture({"Y": fractions(photo).values}, frame, frame)
    inputs = of_depths(as_exr)(inputs)
    return inputs.but(more=(*inputs.more, "--disparity"))


def jpeg(path, photo, orientation):
    png(path.with_suffix(".png"), Photo(photo.stored(orientation)))
    subprocess.run(["oiiotool", path.with_suffix(".png"), "--orientation", str(orientation), "--attrib", "jpeg:subsampling", "4:4:4", "--compression", "jpeg:100", "-o", path], check=True)


def own_jpeg(kind, format="RangeInverse"):
    """A writer of a JPEG that has its depth in the way of that kind (own_depth.py)."""
    def write(path, photo, orientation=1):
        jpeg(path, photo, orientation)
        near, far, disparity, more = own_depth.NEAR, own_depth.FAR, photo.own / 255, []
        if format == "RangeLinear":
            z = 1 / (1 / far + disparity * (1 / near - 1 / far))
            disparity, more = 1 - (z - near) / (far - near), [format]
        stored = Photo((65535 * (disparity if kind == "apple" else 1 - disparity)).round().astype("u2")).stored(orientation)
        depth = path.with_suffix(".depth" + (".jpg" if kind == "apple" else ".png"))
        if kind == "apple":
            jpeg(depth, Photo((stored // 257).astype("u1")), 1)
        else:
            png(depth, Photo(stored))
        path.write_bytes(own_depth.KINDS[kind](path.read_bytes(), depth.read_bytes(), *more))
    return write


def own_as(kind, *format, **form):
    return photo_as(own_jpeg(kind, *format), ".jpg", **form)


def own_heif(path, photo, turn=0):
    def stored(values):
        values = numpy.rot90(values if values.ndim == 3 else numpy.repeat(values[:, :, None], 3, 2), -turn)
        return values.shape[1], values.shape[0], values.tobytes()
    heif.write(path, stored(photo.values), stored(photo.own), turn)


def wide(photo):
    return Photo(photo.values.astype("u2") * 257)


def opaque(picture):
    """Everything covered, over a grey ground."""
    if picture.counts is not None or "A" not in picture.channels:
        return picture.each(lambda name, v: v * 0 + 1 if name == "A" else v)
    empty = 1 - picture.channels["A"]
    return picture.each(lambda name, v: v * 0 + 1 if name == "A" else numpy.where(v >= SKY, numpy.float32(12), v) if is_depth(name)
                        else scene.half(v + empty / 4) if name in "RGB" else v)


def renumbered(picture):
    return picture.each(lambda name, v: numpy.array([0, 3, 5, 1, 2, 4], v.dtype)[v.astype(int)] if name.startswith("IndexOB") else v)


def renumbered_back(picture):
    return picture.each(lambda name, v: numpy.array([0, 3, 4, 1, 5, 2], v.dtype)[v.astype(int)] if name.startswith("IndexOB") else v)


def without_ids(picture):
    """OpenImageIO makes floats of integers; ids of views that are equally near are those of the first."""
    return picture.only([name for name in picture.channels if not name.startswith("IndexOB")])


def recompressed(method):
    def write(path, picture):
        exr(path, picture)
        subprocess.run(["oiiotool", path, "--compression", method, "-o", path.with_suffix(".2.exr")], check=True)
        os.replace(path.with_suffix(".2.exr"), path)
    return lambda inputs: inputs.but(picture=write)


def mirrored(picture):
    picture = picture.mirrored().each(lambda name, v: -v if name == "ldi.dx" else v).renamed(lambda name: {"view_0": "view_2", "view_2": "view_0"}.get(name, name))
    return placed(lambda x, y: (-x, y))(picture)


def transposed(picture):
    names = {"ldi.dx": "ldi.dy", "ldi.dy": "ldi.dx", "view_0": "view_3", "view_3": "view_0", "view_1": "view_2", "view_2": "view_1"}
    return placed(lambda x, y: (-y, -x))(picture.transposed().renamed(lambda name: names.get(name, name)))


def upright(inputs):
    lens = dict(inputs.lens)
    if "sensor-width" in lens:
        lens["sensor-width"] *= scene.HEIGHT / scene.WIDTH
    return inputs.but(lens=lens)


UNITS = {"focus-distance": 1000, "scene-unit": 0.001}
CHANGES = {
    "tiles": Change(written(tile=(16, 12))),
    "tiles-backwards": Change(written(tile=(7, 5), decreasing=True)),
    "lines-backwards": Change(written(decreasing=True)),
    "uncompressed": Change(written(compression="none")),
    "zips": Change(written(compression="zips")),
    "rle": Change(recompressed("rle"), first=pictures(without_ids)),
    "piz": Change(recompressed("piz"), first=pictures(without_ids)),
    "parts": Change(in_parts),
    "prefix": Change(pictures(prefixed), unprefixed),
    "half": Change(pictures(as_half)),
    "no-alpha": Change(pictures(lambda p: p.only([n for n in p.channels if n != "A"])), first=pictures(opaque), without=("A",)),
    "moved": Change(pictures(shifted(-37, -1001)), shifted(37, 1001)),
    "cut": Change(cut),
    "overscan": Change(pictures(grown)),
    "names": Change(lambda inputs: inputs.but(name="Bär & {} 100%, 'ü'"), needs="a file"),
    "stdin": Change(lambda inputs: inputs.but(through="stdin"), needs="a file"),
    "fifo": Change(lambda inputs: inputs.but(through="fifo"), needs="a file"),
    "frames": Change(lambda inputs: inputs.but(through="frames", name="{}.####"), needs="a file"),
    "order": Change(backwards, needs="a file"),
    "light": Change(pictures(scaled(is_light, 2)), scaled(is_light, 0.5), figures={"max": 0.5, "p99": 0.5}),
    "scaled": Change(larger(4, {"lens-radius": 4, "focus-distance": 4}), scaled(is_distance, 0.25), figures={"focus_distance": 0.25, "lens_radius": 0.25}, needs="a depth"),
    "units": Change(larger(1000, UNITS), scaled(is_distance, 0.001), 1e-4, by_fstop, needs="a depth", figures={"focus_distance": 0.001, "lens_radius": 0.001}),
    "ids": Change(pictures(renumbered), renumbered_back, needs="an id"),
    "mirrored": Change(pictures(mirrored), mirrored, first=pictures(without_ids)),
    "transposed": Change(in_turn(pictures(transposed), upright), transposed, first=pictures(without_ids)),
    "inverse": Change(depth_as("inverse", lambda z, _: 1 / z), needs="a flat depth", bound=1e-5),
    "negative": Change(depth_as("negative", lambda z, _: -z), needs="a flat depth", bound=1e-5),
    "along-rays": Change(depth_as("distance", along_rays), needs="a flat depth", bound=1e-5),
    "white-near": Change(depth_as("normalized", lambda z, _: (17 - z.clip(1, 17)) / 16, "--near", "17", "--far", "1"), needs="a flat depth", bound=1e-5),
    "depth-buffer": Change(depth_as("hyperbolic", lambda z, _: (1 - 1 / z) / (1 - 1 / 17), "--near", "1", "--far", "17"), needs="a flat depth", bound=1e-5),
    "16-bits": Change(lambda inputs: inputs.each(wide, Photo), bound=1e-5, needs="a photograph"),
    "depth-pfm": Change(depth_as_pfm("<"), needs="a photograph", bound=1e-5),
    "depth-pfm-big-endian": Change(depth_as_pfm(">"), needs="a photograph", bound=1e-5),
    "depth-exr": Change(depth_as_exr, needs="a photograph", bound=1e-5),
    "photo-exr": Change(lambda inputs: inputs.each(lambda photo: linear(photo) if photo.values.ndim == 3 else photo, Photo), needs="a photograph", bound=1e-5),
    "tiff": Change(photo_as(tiff, ".tif"), needs="a photograph"),
    "tiff-big-endian": Change(in_turn(lambda inputs: inputs.each(wide, Photo), photo_as(tiff, ".tif", order=">")), bound=1e-5, needs="a photograph"),
    **{f"exif-{k}": Change(photo_as(png, ".png", orientation=k), needs="a photograph") for k in range(2, 9)},
    "exif-6-jpeg": Change(photo_as(jpeg, ".jpg", orientation=6), bound=0.05, needs="a photograph"),
    "exif-6-tiff": Change(photo_as(tiff, ".tif", orientation=6), needs="a photograph"),
    **{f"own-{kind}": Change(own_as(kind), needs="a depth of its own") for kind in ("elements", "dynamic")},
    "own-apple": Change(own_as("apple"), bound=0.01, needs="a depth of its own"),
    "own-linear": Change(own_as("dynamic", "RangeLinear"), bound=0.001, needs="a depth of its own"),
    **{f"own-exif-{k}": Change(own_as("gdepth", orientation=k), bound=0.05, needs="a depth of its own") for k in range(2, 9)},
    **{f"own-avif-{turn}": Change(photo_as(own_heif, ".avif", turn=turn), bound=0.05, needs="a depth of its own")
       for turn in (0, 1, 3) if heif.can_write(".avif")},
    "control": Change(pictures(brighter)),
}
NEVER = {
    "zips": {"deep": "deep files have it already", "two deep": "deep files have it already"},
    "parts": {name: "its files have one layer" for name in ("compare", "gather-photo-exr", "finish", "gather-depth-file")},
    "no-alpha": {"gather-photo-exr": "its files have none"},
    "cut": {"gather-photo-exr": "it is full", "views": "where the centre view has no pixels, rim views add what they see",
            "python": "the same", "plan": "rectangles lie in the centre view's data window", "compare": "compares the reference's data window"},
    "overscan": {"compare": "compares the reference's data window"},
    "photo-exr": {"gather-photo-exr": "it is one", "gather-photo-coarse": "linear colours vary in other places, so other cells count"},
    "half": {"gather-ldi": "what ldi-warp writes are no halves", "gather-selective": "what ldi-warp writes are no halves", "gather-photo-exr": "its values are no halves", "cluster": "what ldi-warp writes are no halves"},
    "order": {"flat": "one file", "deep": "one file", "match": "one file", "photo": "one file", "compare": "one is the reference"},
    "frames": {"compare": "measures the change between frames", "match": "one file of keys has all frames", "python": "the caller numbers its frames"},
    "mirrored": {"gather-photo-exr": "its depth is no EXR", "finish": "blocks of 32 pixels from the left tell how certain renders are"},
    "transposed": {"gather-photo-exr": "its depth is no EXR"},
    "light": {"finish-ask": "rays are asked for what a display shows"},
    "stdin": {"gather-photo": "says that it needs a file", "gather-photo-coarse": "the same", "gather-photo-own": "the same", "python": "reads no stream", "pipe": "its requests come there"},
    "fifo": {"pipe": "refuses what is no file", "photo": "says that it needs a file"},
}
LENS_DOORS = "gather-view", "gather-deep", "gather-ldi", "gather-depth-file", "gather-photo-exr", "pipe", "python", "match"
LAMPS = "lamps, whose discs are exact, are told in cells of 32 pixels from the corner of what is gathered; all else is a pattern of points"
SLOW = {"match"}  # doors
KNOWN = {  # faults that are not mended yet: (door, change): why
    ("warp-denoised", "light"): "details are weighted by a tone curve without an exposure: two pixels in 1536 have one sample more",
}
BOUNDS = {  # in place of that of the change, with the reason
    "half": {kind: (5e-4, "where they get halves, they write halves: one rounding") for kind in ("views", "two deep", "pipe")},
    **{name: {door: (2e-6, "OpenImageIO multiplies by a rounded 1/255") for door in ("gather-photo", "gather-photo-coarse", "gather-photo-exr")} for name in ("tiff", "exif-6-tiff")},
    "light": {"match": (0.05, "dof-match compares the tones of a display")},
    "order": {"warp-denoised": (1e-6, "other sums"), "finish": (1e-6, "other sums")},
    "cut": {"gather-ldi": (0.01, LAMPS), "match": (0.1, LAMPS), "warp-denoised": (1e-6, "other sums")},
    "overscan": {**{door: (0.1, LAMPS) for door in LENS_DOORS}, "warp-denoised": (1e-6, "other sums")},
    **{name: {**{door: (0.1, LAMPS) for door in LENS_DOORS}, "compare": (1e-12, "other sums"),
              "warp-denoised": (1e-6, "other sums"), "finish": (1e-6, "other sums")} for name in ("mirrored", "transposed")},
    "depth-buffer": {"python": (5e-3, "depths are rounded, and a lens point sees another thing"), "views": (5e-4, "positions are halves")},
}


# ---- Comparing ----
def on_canvas(picture, display, around):
    """With nothing around, so that pictures of different windows can be compared."""
    left, top, right, bottom = display
    return picture.windowed((left - around, top - around, right + around, bottom + around))


def largest(a, b, name):
    """(the largest difference of two arrays, relative above 1, a sentence)"""
    a, b = (numpy.where(v >= 65504, numpy.inf, v) if is_depth(name) else v for v in (numpy.asarray(a, float), numpy.asarray(b, float)))
    with numpy.errstate(invalid="ignore"):
        d = numpy.where((a == b) | (a != a) & (b != b), 0, numpy.nan_to_num(abs(a - b) / numpy.maximum(1, abs(a)), nan=numpy.inf))
    if not d.size or d.max() == 0:
        return 0, ""
    at = numpy.unravel_index(d.argmax(), d.shape)
    return d.max(), f"{name} is {b[at]:.7g}, not {a[at]:.7g}, in place {','.join(map(str, at))}; {(d > 0).sum()} differ"


def difference(expected, got, change, around):
    if isinstance(expected, dict):
        factors = change.figures
        names = [name for name in expected if name.split(".")[0] in factors] or list(expected)
        return max((largest(expected[n], got.get(n, numpy.nan) * factors.get(n.split(".")[0], 1), n) for n in names), key=lambda d: d[0])
    a, b = (on_canvas(p.only([n for n in p.channels if n not in change.without]), expected.display, around)
            for p in (expected, change.undo(got)))
    if sorted(a.channels) != sorted(b.channels) or expected.display != change.undo(got).display:
        return numpy.inf, f"{got.display} {' '.join(sorted(b.channels))}, not {expected.display} {' '.join(sorted(a.channels))}"
    if a.counts is not None and (a.counts != b.counts).any():
        y, x = numpy.argwhere(a.counts != b.counts)[0]
        return numpy.inf, f"{b.counts[y, x]} samples, not {a.counts[y, x]}, in pixel {x + a.data[0]},{y + a.data[1]}; {(a.counts != b.counts).sum()} pixels differ"
    return max((largest(v, b.channels[name], name) for name, v in a.channels.items()), key=lambda d: d[0])


def cell(name, change_name):
    """The largest difference of a cell, in words, and how large it may be."""
    door, change = DOORS[name], CHANGES[change_name]
    first = change.first(Inputs(BENCH.once(name, files=True), scene.LENS))
    before, signature = BENCH.once(name, change=change_name, inputs=first)
    results, other = BENCH.make(door, change.change(first), BENCH.folder / name / change_name)
    if signature == other:
        raise Wrong("changes nothing of what it is given: say so in NEVER")
    around = -10 if at_border(name, change_name) else 16
    return max((difference(expected, result[output], change, around) for result in results for output, expected in before[0].items()),
               key=lambda d: d[0])


def at_border(door, change):
    """A photograph fills its frame: with more pixels beyond it, the blur at its border is another."""
    return (door, change) == ("gather-photo-exr", "overscan")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--python", type=pathlib.Path)
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("--only", default=",")
    parser.add_argument("--keep", type=pathlib.Path)
    asked = parser.parse_args()
    door, change = (asked.only.split(",") + [""])[:2]
    if asked.python:
        ENVIRONMENT["PYTHONPATH"] = str(asked.python.resolve())
    else:
        del DOORS["python"]
    global BENCH
    with tempfile.TemporaryDirectory() as scratch:
        BENCH = Bench(asked.bin.resolve(), (asked.keep or pathlib.Path(scratch)).resolve(), asked.keep)
        if not heif.can_write(".avif"):
            print("skipped: AVIF, which libheif cannot write here")
        cells = [(d, c) for d in DOORS for c in CHANGES if (d in SLOW) == asked.slow or door
                 if door in ("", d) and change in ("", c)]
        never = {(d, c): reason for d, c in cells for who, reason in NEVER.get(c, {}).items() if who in (d, DOORS[d].kind)}
        for d in {d for d, _ in cells}:
            given = sum(BENCH.once(d, files=True).values(), [])
            never.update({(d, c): f"has not {CHANGES[c].needs}" for c in CHANGES if not any(map(NEEDS[CHANGES[c].needs], given))})
        never = {at: reason for at, reason in never.items() if at in cells}

        def judge(at):
            try:
                worst, words = cell(*at)
                bound = next((bound for who, (bound, _) in BOUNDS.get(at[1], {}).items() if who in (at[0], DOORS[at[0]].kind)), CHANGES[at[1]].bound)
                wrong, words = bool((worst <= bound) == (at[1] == "control")), f"{worst:.3g} {words}"
            except Exception as error:
                wrong, words = True, f"{type(error).__name__} {error}"
            return (wrong, words) if at not in KNOWN else (not wrong, f"known: {words}" if wrong else "is mended: take it out of KNOWN")
        wrong = 0
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            tried = [at for at in cells if at not in never]
            for at, (bad, words) in zip(tried, pool.map(judge, tried)):
                wrong += int(bad)
                if bad or asked.only != ",":
                    print(f"{'WRONG' if bad else 'right'}: {at[0]}, {at[1]}: {words}" + bad * f"; to repeat it: {' '.join(sys.argv[:2])} --only {','.join(at)} --keep FOLDER")
        print(f"{len(tried)} cells, {wrong} wrong; {len(never)} do not apply")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
