"""Takes the pictures of a scene's frame, bit by bit, and shows them."""

import os

import bpy

from . import costs, pictures, tools
from .chain import Chain, ToolError
from .kept import of_other_file
from .looks import looks_of
from .renders import folder_of, used_layers
from .shots import eyes_of, shot_of
from .shutter import shutter_options
from .sub_pixels import supersample_in
from .write_access import with_write_access

ERRORS = ValueError, OSError, RuntimeError, ToolError


def chosen_folder():
    """The tools' folder from the preferences."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences.folder if addon and addon.preferences else ""


def lens_state(scene):
    """The settings that can change the picture after the render."""
    looks = looks_of(scene.sparselens)
    return (scene.name, scene.frame_current, *[
        word for eye in eyes_of(scene)
        for word in pictures.lens_options(shot_of(scene, eye), looks)])


def image_of(scene, eye, path):
    """Blender's image of the picture of an eye of the scene with this name,
    reloaded from the file. An image of a scene that is not there is of this
    one, by its former name."""
    own = [image for image in bpy.data.images if image.get("sparselens")
           and image["sparselens_eye"] == eye.file_suffix]
    image = next((image for image in own
                  if image["sparselens"] == scene), None)
    if image is None:
        image = next((image for image in own
                      if image["sparselens"] not in bpy.data.scenes), None)
    if image is None:
        image = bpy.data.images.load(path)
        image.use_view_as_render = True
    image["sparselens"] = scene
    image["sparselens_eye"] = eye.file_suffix
    image.name = "sparselens, " + scene + eye.file_suffix
    image.filepath = path
    image.reload()
    return image


def editors():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                yield area


def show(image):
    """Shows the image in the image editors that show nothing else."""
    for area in editors():
        space = area.spaces.active
        if space.image is None or space.image.type == "RENDER_RESULT":
            space.image = image
        area.tag_redraw()


class PictureJob:
    """The pictures of the current frame, one for each eye: warps if the views
    are newer than the LDI, then gathers; with `draft`, gathers a draft
    first."""

    def __init__(self, scene, draft):
        settings = scene.sparselens
        folder, _ = tools.find(chosen_folder())
        views = folder_of(settings.folder)
        self.scene, self.state = scene.name, lens_state(scene)
        self.warnings = []
        self.images = []
        warps, drafts, finals = [], [], []
        for eye in eyes_of(scene):
            files, shot = pictures.files_to_take(
                scene, views, eye, settings.views, supersample_in(settings),
                settings.shutter)
            self.warnings += filter(None, [of_other_file(files.each("center"))])
            layer = settings.multilayer and used_layers(scene)[0]
            ldi, made = files.of_moments("ldi"), files.path("picture")
            sketch = os.path.join(bpy.app.tempdir, os.path.basename(made))
            options = pictures.lens_options(shot, looks_of(settings))
            options += shutter_options(scene, settings.shutter, views)
            size = [side // shot.supersample for side in shot.size]
            warps += [(command, None) for command in pictures.warp_commands(
                folder, files, layer)]
            drafts.append((pictures.gather_command(
                folder, ldi, sketch, options + pictures.draft_options(
                    size[0], shot.supersample)), (eye, sketch, size)))
            finals.append((pictures.gather_command(
                folder, ldi, made, options), (eye, made, None)))
        self.stages = ([("warping", warps)]
                       + ([("a draft", drafts)] if draft else [])
                       + [("the picture", finals)])
        self.files, self.cost = files, ""  # of the last eye
        self.words, self.chain, self.to_show = "", None, []

    @property
    def interruptible(self):
        """Whether the last stage runs, so that a newer picture may begin."""
        return not self.stages

    def tick(self):
        """Returns whether all is done. Raises the error if a stage failed."""
        while self.chain is None or self.chain.poll():
            if self.chain is not None:
                self.warnings += self.chain.warnings
                for eye, path, size in self.to_show:
                    self.show(eye, path, size)
            if not self.stages:
                self.cost = costs.in_words(
                    pictures.rendered_files(self.files), self.chain.seconds)
                return True
            self.words, commands = self.stages.pop(0)
            self.chain = Chain([command for command, _ in commands])
            self.to_show = [shown for _, shown in commands if shown]
        return False

    def show(self, eye, path, size):
        image = image_of(self.scene, eye, path)
        # An image with passes has no size.
        if size and tuple(image.size) not in ((0, 0), tuple(size)):
            image.scale(*size)
        show(image)
        self.images = [image.name for image in bpy.data.images
                       if image.get("sparselens") == self.scene]

    def wait(self):
        while not self.tick():
            self.chain.wait()

    def stop(self):
        self.stages, self.to_show = [], []
        if self.chain is not None:
            self.chain.stop()


class Follower:
    """Takes the picture again whenever a setting of the lens has changed: a
    draft, then in full. A draft in progress is shown before the next
    begins."""

    def __init__(self, state):
        self.seen, self.job = state, None
        self.message = ""  # an error or a warning

    def tick(self, scene):
        if bpy.app.is_job_running("RENDER"):
            return
        try:
            state = lens_state(scene)
            if self.job is None or self.job.interruptible:
                if state != self.seen:
                    self.stop()
                    self.seen, self.message = state, ""
                    self.job = PictureJob(scene, draft=True)
            if self.job and self.job.tick():
                self.message = (self.job.warnings or [""])[0]
                self.job = None
        except ERRORS as error:
            self.stop()
            self.message = str(error)

    def stop(self):
        if self.job:
            self.job.stop()
        self.job = None


follower = None
INTERVAL = 0.05  # seconds


def follow():
    """The callback of Blender's timer."""
    scene = bpy.context.scene
    if follower is None or not scene.sparselens.live:
        stop_following()
        return None
    with_write_access(lambda: follower.tick(scene))
    return INTERVAL


def start_following(state):
    global follower
    stop_following()
    follower = Follower(state)
    bpy.app.timers.register(follow, first_interval=INTERVAL)


def stop_following():
    global follower
    if follower is not None:
        follower.stop()
    follower = None
    if bpy.app.timers.is_registered(follow):
        bpy.app.timers.unregister(follow)


@bpy.app.handlers.persistent
def stop_at_load(*_):
    """Stops, because another file has another camera."""
    stop_following()
