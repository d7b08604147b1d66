"""The systems that a report compares: a renderer, and a processor that makes depth of field from its pictures. They add
the steps that their pictures need."""
import dataclasses
import os
import tempfile

from rows import Rendered, Row, shortest
from steps import Failure, Step, UsageError, matching, read_camera, run_process

PULL_FRAMES, PULL_TO = 16, 1.1  # a pull of focus to so many times its distance
LAYERS, LENS_VIEW_SAMPLES = 4, 4  # with fewer samples per pixel, sub-pixel shifts of the views cost much
LENS = {"--focal-length": "focal_mm", "--sensor-width": "sensor_width_mm", "--lens-radius": "lens_radius",
        "--focus-distance": "focus_distance"}


@dataclasses.dataclass
class Budgets:
    size: str = "640x360"
    reference: int = 4096  # rays per pixel
    samples: tuple = (1, 4, 16, 64)  # per pixel of a view
    lens_views: tuple = (4, 16, 64, 256, 1024)  # rendered over the lens
    rays: tuple = (4, 16, 64, 256, 1024)  # per pixel, distributed over the lens
    many_points: int = 4096  # so many lens points that more change nothing


class TracedScene:
    """A built-in scene. dof-trace renders only what the rows need. Methods return None for pictures that it lacks."""
    lens, denoised_rays, finished = [], [], lambda self: []  # those of ready-made views alone

    def __init__(self, name, budgets, tools, steps):
        self.name, self.budgets, self.steps = name, budgets, steps
        self.can_plan = os.path.exists(os.path.join(tools, "ldi-plan"))
        self.samples, self.rays, self.lens_views = budgets.samples, budgets.rays, budgets.lens_views
        # The budgets for which each pixel of a view of twice the size gets a whole number of samples.
        self.fine_samples = [count for count in budgets.samples if count % 4 == 0]
        with tempfile.TemporaryDirectory() as folder:
            try:
                run_process([f"{tools}/dof-trace", name, *"--size 8x8 --spp 1 --views 0 -o".split(), folder], folder)
            except Failure as error:
                if error.args[1:] != (2,):
                    raise
                raise UsageError(f"{name}: neither a built-in scene nor a folder with a camera.json")
            self.focus = read_camera(folder)["focus_distance"]

    def trace(self, folder, samples, *more):
        return ["dof-trace", self.name, "--size", self.budgets.size, "--spp", *map(str, [samples, *more]), "-o", folder]

    def weight(self, rays):
        width, height = map(int, self.budgets.size.split("x"))
        return 0.1 + rays * width * height / 1.5e7

    def made(self, name, files, trace, rays, cost, unasked=True, **fields):
        """Adds the step that traces the files."""
        folder = f"{self.name}/{name}"
        outputs = [f"{folder}/{file}" for file in files]
        step = Step(folder, [("render", self.trace(folder, *trace))], outputs=outputs, weight=self.weight(cost),
                    traced=folder if unasked else "")
        return Rendered(folder, outputs[0], rays, steps=[self.steps.add(step)], **fields)

    def reference(self):
        """Has random numbers of its own: noise shared with the measured pictures would look like agreement."""
        rays = self.budgets.reference
        made = self.made("reference", ["reference.exr"], [1, "--views", 0, "--reference", rays, "--seed", 1], 0, rays)
        made.steps[0].timed = False
        return made

    def views(self, rim, samples, fine=False, denoised=False):
        if denoised:
            return None
        views, rays = [f"view_{k}.exr" for k in range(rim)], (1 + rim) * samples
        made = self.made(f"{'fine' if fine else 'views'}-{1 + rim}x{samples}", ["center.exr", *views],
                         [samples, "--views", rim, *(["--supersample", 2] if fine else [])], rays, rays, unasked=False,
                         views=1 + rim, supersample=2 if fine else 1)
        made.rim = [[f"{made.folder}/{view}"] for view in views]
        return made

    def layers(self, kind, samples):
        trace, rays = [samples, "--views", 0, "--deep", f"{kind}:{LAYERS}"], LAYERS * samples  # each layer is shaded
        return self.made(f"{kind}-{LAYERS}x{samples}", [f"deep_{kind}.exr"], trace, rays, rays + samples)

    def accumulated(self, views):
        folder, rays = f"{self.name}/accumulated-{views}", LENS_VIEW_SAMPLES * views
        picture, scratch = folder + "/picture.exr", folder + "/views"
        average = ["dof-accumulate", "-o", picture, *(f"{scratch}/lens_{k:04}.exr" for k in range(views))]
        trace = self.trace(scratch, LENS_VIEW_SAMPLES, "--views", 0, "--lens-views", views)
        step = Step(folder, [("render", trace), ("process", average)], outputs=[picture], fresh=scratch, scratch=True,
                    traced=scratch, weight=self.weight(rays) + 0.06 * views)
        return Rendered(folder, picture, rays, steps=[self.steps.add(step)], views=views)

    def distributed(self, rays, denoised=False):
        return self.made(f"traced-{rays}", ["reference.exr"], [1, "--views", 0, "--reference", rays], rays, rays)

    def planned(self, rim, samples):
        """What a plan requests is known only after it is made, so the views are named by a pattern and their rays
        counted later."""
        if not self.can_plan:
            return None
        centre = self.views(0, samples)
        folder = f"{self.name}/planned-{1 + rim}x{samples}"
        plan, rendered = folder + "/plan.json", folder + "/views"
        asked = Step(folder + "/plan", [("plan", ["ldi-plan", centre.picture, "--views", str(rim), "-o", plan])],
                     centre.steps, outputs=[plan])
        made = Step(rendered, [("render", self.trace(rendered, samples, "--plan", plan))], [self.steps.add(asked)],
                    outputs=[rendered + "/camera.json"], fresh=rendered, weight=self.weight(samples))
        return dataclasses.replace(centre, folder=folder, rim=[[rendered + "/view_*.exr"]], partial_samples=samples,
                                   steps=[*centre.steps, *made.inputs, self.steps.add(made)])


def plain_name(name):
    """Keeps letters, digits and dots, because the name becomes part of file names and of the page."""
    return "".join(c if c.isascii() and c.isalnum() or c == "." else "-" for c in name)


class ReadyScene:
    """A folder of ready-made views with camera.json, reference.exr, center.exr, view_K.exr and optionally drt_N.exr (N
    rays per pixel over the lens), denoised versions of these (center.denoised.exr, ...; lab/denoise), pictures that
    camera.json lists as "others", frames of a focus pull (drt_N.pull.0001.exr, ...) and further such folders for other
    sample counts, or with finer views."""
    lens_views, layers, planned = [], lambda self, *_: None, lambda self, *_: None

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        self.name = plain_name(os.path.basename(self.folder))
        self.camera = read_camera(self.folder)
        if not os.path.exists(self.path("reference.exr")):
            raise Failure(f"{self.path('reference.exr')}: no such file")
        self.of_size = {self.camera["view_spp"]: (self.folder, self.camera)}, {}  # by samples per pixel; finer views
        for path in sorted(map(self.path, os.listdir(self.folder))):
            if os.path.exists(os.path.join(path, "camera.json")):
                camera = read_camera(path)
                self.of_size[camera["supersample"] > 1].setdefault(camera["view_spp"], (path, camera))
        self.samples, self.fine_samples = map(sorted, self.of_size)
        self.rays, self.denoised_rays = self.counts(".exr"), self.counts(".denoised.exr")
        self.focus = self.camera["focus_distance"]
        self.lens = [word for option, key in LENS.items() for word in (option, shortest(self.camera[key]))]

    def path(self, file):
        return os.path.join(self.folder, file)

    def counts(self, ending):
        """N of each drt_N with that ending that is there and has a time."""
        names = [name[4:-len(ending)] for name in self.camera["seconds"]
                 if name.startswith("drt_") and name.endswith(ending) and os.path.exists(self.path(name))]
        return sorted(int(n) for n in names if n.isdigit())

    def single(self, name, file, rays):
        """A picture without steps, and the frames of a focus pull beside it: FILE.pull.0001.exr and so on."""
        seconds = self.camera["seconds"]
        if file not in seconds:
            raise Failure(f"{self.path('camera.json')}: no seconds of {file}")
        pull = matching(os.path.splitext(self.path(file))[0] + ".pull.*.exr")
        return Rendered(f"{self.name}/{name}", self.path(file), rays, seconds=[seconds[file], 0, 0, 0, 0], pull=pull)

    def reference(self):
        return Rendered(self.name + "/reference", self.path("reference.exr"))

    def views(self, rim, samples, fine=False, denoised=False):
        """Takes every (N / rim)-th of N views that are evenly spaced on the rim."""
        path, camera = self.of_size[fine][samples]
        ending = ".denoised.exr" if denoised else ".exr"
        points, seconds = camera["views"], camera["seconds"]
        if rim and (rim > len(points) or len(points) % rim) or "center" + ending not in seconds:
            return None
        chosen = range(0, len(points), len(points) // rim) if rim else []
        names = ["center" + ending, *(f"view_{k}{ending}" for k in chosen)]
        if not set(names) <= set(seconds):
            raise Failure(f"{path}/camera.json: no seconds of one of {', '.join(names)}")
        files = [os.path.join(path, name) for name in names]
        positions = [",".join(shortest(camera["lens_radius"] * at) for at in points[k]) for k in chosen]
        kind = ("fine" if fine else "views") + ("-denoised" if denoised else "")
        return Rendered(f"{self.name}/{kind}-{1 + rim}x{samples}", files[0], (1 + rim) * samples,
                        [["--view", at, file] for at, file in zip(positions, files[1:])], views=1 + rim,
                        seconds=[sum(map(seconds.get, names)), 0, 0, 0, 0], supersample=camera["supersample"])

    def distributed(self, rays, denoised=False):
        return self.single(f"traced{'-denoised' if denoised else ''}-{rays}",
                           f"drt_{rays}{'.denoised' if denoised else ''}.exr", rays)

    def finished(self):
        """Pictures made by other programs: (renderer, processor, budget, the picture)."""
        return [(*names, self.single(plain_name(file), file, rays)) for file, *names, rays in self.camera["others"]]


def open_scene(scene, budgets, tools, steps):
    return ReadyScene(scene) if os.path.exists(f"{scene}/camera.json") else TracedScene(scene, budgets, tools, steps)


class Chain:
    """Adds the steps from rendered pictures to a picture with depth of field. Files of layers are pairs: a file, and
    the steps that made it."""

    def __init__(self, scene, rendered, budgets, steps):
        self.scene, self.rendered, self.budgets, self.steps = scene, rendered, budgets, steps
        # Reduces the picture to the size of the reference, if the views are larger.
        self.size = ["--supersample", str(rendered.supersample)] if rendered.supersample > 1 else []

    def then(self, source, stage, name, words, options, **more):
        name, rendered = f"{self.rendered.folder}/{name}", self.rendered
        given = [] if rendered.steps else [rendered.picture, *(words[-1] for words in rendered.rim)]
        step = Step(name, [(stage, [*words, *options, *self.scene.lens, "-o", name + ".exr"])], source[1], given,
                    [name + ".exr"], **{"weight": 1.2} | more)
        return name + ".exr", [*source[1], self.steps.add(step)]

    def warped(self):
        """Warps sparse views into one LDI; a single picture is used as it is."""
        source, rim = (self.rendered.picture, self.rendered.steps), self.rendered.rim
        return self.then(source, "warp", "warped", ["ldi-warp", source[0]], sum(rim, [])) if rim else source

    def clustered(self, name, *options):
        """For methods whose work grows with the layers."""
        source = self.warped()
        return self.then(source, "cluster", name, ["ldi-cluster", source[0]], options) if self.rendered.rim else source

    def gathered(self, source, name, *options, **more):
        return self.then(source, "process", name, ["dof-gather", source[0]], [*options, *self.size], **more)

    def many_points(self):
        """This step counts in no row's time."""
        return self.gathered(self.warped(), "many-points", "--method", "lens", "--lens-samples",
                             str(self.budgets.many_points), weight=4, timed=False)[0]

    def pull(self, quality):
        """A focus pull; its step counts in no row's time either."""
        file, made_by = self.warped()
        name, lens = f"{self.rendered.folder}/pull-{quality}", self.scene.lens[:-2]  # all but the focus distance
        keys = f"1:{shortest(self.scene.focus)},{PULL_FRAMES}:{shortest(PULL_TO * self.scene.focus)}"
        words = ["dof-gather", file, "--quality", quality, "-o", name + ".####.exr", *self.size, *lens,
                 "--focus-distance", keys, "--frames", f"1-{PULL_FRAMES}"]
        frames = [f"{name}.{k:04}.exr" for k in range(1, PULL_FRAMES + 1)]
        self.steps.add(Step(name, [("process", words)], made_by, outputs=frames, timed=False, weight=8))
        return frames

    def processed(self, processor):
        if processor.startswith("lens "):
            quality = processor.split()[1]
            return self.gathered(self.warped(), "lens-" + quality, "--method", "lens", "--quality", quality)
        if processor == "scatter":
            return self.gathered(self.clustered("clustered"), "scatter", "--method", "scatter", weight=4)
        k = processor.partition("K=")[2] or "8"
        return self.gathered(self.clustered("clustered-" + k, "--layers", k), "selective-" + k,
                             "--method", "selective", "--layers", k)


QUICK = ["scatter", "gather", "layered blend", "selective K=8", "lens normal"]
EVERY = ["selective K=2", "selective K=4", "selective K=8", "lens draft", "lens normal", "lens final"]


def systems(scene):
    """(renderer, unit of the budget, budgets, what renders one, processors, the role of rows of the lens gather or of
    all rows without a processor). Without processors the renderer makes depth of field itself."""
    def of_views(rim, **kind):
        return lambda samples: scene.views(rim, samples, **kind)
    samples, fine, blended = scene.samples, scene.fine_samples, ["layered blend", "lens normal"]
    return [
        ("one view", "sample", samples, of_views(0), ["scatter", "gather", "lens normal"], ""),
        ("4 strata", "sample", samples, lambda n: scene.layers("strata", n), blended, ""),
        ("4 peeled layers", "sample", samples, lambda n: scene.layers("peel", n), blended, ""),
        ("accumulated lens views", "view", scene.lens_views, lambda n: scene.accumulated(n), [], ""),
        ("distributed ray tracing", "ray", scene.rays, scene.distributed, [], "traced"),
        ("denoised ray tracing", "ray", scene.denoised_rays, lambda n: scene.distributed(n, denoised=True), [], ""),
        ("centre + 4", "sample", samples, of_views(4), EVERY, "sparse"),
        ("centre + 4", "sample", fine, of_views(4, fine=True), ["lens normal", "lens final"], "sparse"),
        ("centre + 8", "sample", samples, of_views(8), EVERY, "sparse"),
        ("centre + 4 denoised", "sample", samples, of_views(4, denoised=True), ["lens normal"], ""),
        ("centre + 4 denoised", "sample", fine, of_views(4, fine=True, denoised=True), ["lens normal"], ""),
        ("centre + 4 planned", "sample", samples, lambda n: scene.planned(4, n), EVERY[3:], "sparse")]


def plan_rows(scene, budgets, quick, steps):
    """The rows of the scene before they are measured."""
    rows = []

    def add(renderer, processor, budget, rendered, role=""):
        renderer += f" at {rendered.supersample}x" if rendered.supersample > 1 else ""
        rows.append(Row(**vars(rendered), scene=scene.name, renderer=renderer, processor=processor, budget=budget,
                        role=role))
        return rows[-1]
    for renderer, unit, counts, render, processors, role in systems(scene):
        for count in counts:
            rendered, budget = render(count), f"{count} {unit}{'s' if count != 1 else ''}"
            if rendered and not processors:
                add(renderer, "", budget, rendered, role)
            for processor in processors if rendered else []:
                if quick and processor not in QUICK:
                    continue
                is_lens, chain = processor.startswith("lens "), Chain(scene, rendered, budgets, steps)
                row = add(renderer, processor, budget, rendered, role if is_lens else "")
                row.picture, row.steps = chain.processed(processor)
                row.many_points = chain.many_points()
                # How steady the lens gather is, of one system alone, because a pull costs as much as 16 pictures.
                if is_lens and row.renderer == "centre + 4" and count == counts[-1]:
                    row.pull = chain.pull(processor.split()[1])
    for finished in scene.finished():
        add(*finished)
    return rows
