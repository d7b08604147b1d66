"""The operators behind the buttons."""

import os
from types import SimpleNamespace

import bpy

from . import costs, nodes
from .chunked import Chunked, Rendering
from .chain import Once
from .finishing import Finishing
from .layers import names_of
from .manner import Count, Manner
from .renders import check_folder, folder_of, render_now, views_steps
from .sequence import Pictures
from .shots import eyes_of
from .sub_pixels import AUTO, supersample_in
from .render_job import (
    ERRORS, PictureJob, chosen_folder, editors, lens_state, start_following,
    stop_following)
from .views import counted, views_of_lens
from .words import report


def frames_of(scene):
    return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)


def manner_of(settings):
    return Manner(AUTO if settings.overscan_auto else settings.overscan,
                  settings.multilayer, supersample=supersample_in(settings),
                  slices=settings.slices, layers=names_of(settings.layers),
                  shutter=settings.shutter)


def views_in(settings):
    """The number of views of a frame and an eye, with the deep ones. Each
    costs a render."""
    return settings.shutter * (
        (settings.views + 1) * (1 + len(names_of(settings.layers)))
        + (settings.slices > 0))


class Renders(Chunked):
    """An operator of steps: prepare(context) sets self.steps; for views also
    self.count."""

    holds = True

    def warn(self, text):
        report(self, "WARNING", text)

    def execute(self, context):
        try:
            self.prepare(context)
            render_now(context.scene, self.steps)
        except ERRORS as error:
            report(self, "ERROR", error)
            return {"CANCELLED"}
        self.done(context)
        return {"FINISHED"}

    def begin(self, context):
        stop_following()
        self.prepare(context)
        self.rendering = Rendering(context.scene, self.steps)
        self.rendering.begin()

    def tick(self, context):
        done = self.rendering.tick()
        context.workspace.status_text_set("sparselens: %s%s; Esc stops" % (
            self.rendering.words, self.so_far()))
        return done

    def so_far(self):
        return ", " + self.count.so_far()

    def may_stop(self):
        """A running render handles Esc by itself."""
        return not bpy.app.is_job_running("RENDER")

    def end(self, context):
        self.rendering.end()


def tell(operator, words):
    if words:
        operator.report({"INFO"}, words)


def say_warnings(operator, taken):
    """Reports the warnings of the pictures, and which images show them."""
    say = Once(lambda text: report(operator, "WARNING", text))
    for text in taken.warnings:
        say(text)
    say.end()
    tell(operator, taken.cost)
    operator.report({"INFO"}, "The image editor shows %s"
                    % ", ".join(taken.images))


class SPARSELENS_OT_render_views(Renders, bpy.types.Operator):
    """Render the centre view and the views from the rim of the lens, each with the samples of the scene: 16 are few for hair, take 64 or more"""

    bl_idname = "sparselens.render_views"
    bl_label = "Render Views"

    def prepare(self, context):
        scene, settings = context.scene, context.scene.sparselens
        frames = [scene.frame_current]
        if settings.animation:
            frames = frames_of(scene)
        views, eyes = views_of_lens(settings.views, 0), eyes_of(scene)
        self.folder, self.count = folder_of(settings.folder), Count()
        check_folder(self.folder, eyes, frames, settings.animation)
        self.steps = views_steps(
            scene, frames, self.folder, lambda frame: views, eyes,
            manner_of(settings), self.count, settings.animation, self.warn)

    def done(self, context):
        tell(self, costs.in_words(self.count.paths))
        self.report({"INFO"}, "%s in %s" % (
            counted(self.count.rendered, "view"), self.folder))


class SPARSELENS_OT_render_animation(Renders, bpy.types.Operator):
    """Render the views of all frames of the scene, and make the pictures that its output settings name"""

    bl_idname = "sparselens.render_animation"
    bl_label = "Render Animation"

    def prepare(self, context):
        scene, settings = context.scene, context.scene.sparselens
        folder, name = os.path.split(scene.render.filepath)
        options = SimpleNamespace(
            output=os.path.join(folder, name if "#" in name
                                else name + "####"),
            views_folder=settings.folder, views=settings.views, layer=None,
            multilayer=settings.multilayer, looks=None,
            finish=(max(settings.finish, 2) if settings.finish_frames
                    else 0),
            tools=chosen_folder())
        manner = manner_of(settings)
        manner.keep = settings.keep
        eyes, frames = eyes_of(scene), frames_of(scene)
        if not settings.keep:
            check_folder(folder_of(settings.folder), eyes, frames, True)
        self.pictures = Pictures(scene, eyes, manner, options, self.warn)
        self.pictures.render_again = ("if more than the lens has changed, "
                                      "switch Keep Views off")
        self.count, self.steps = (self.pictures.count,
                                  self.pictures.steps(frames))

    def done(self, context):
        tell(self, self.pictures.cost)
        self.report({"INFO"}, self.pictures.words())


class SPARSELENS_OT_take_picture(Chunked, bpy.types.Operator):
    """Make the picture of the views, with the focus and f-stop that the camera has now"""

    bl_idname = "sparselens.take_picture"
    bl_label = "Take Picture"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            self.job = PictureJob(context.scene, draft=False)
            self.job.wait()
        except ERRORS as error:
            report(self, "ERROR", error)
            return {"CANCELLED"}
        self.say_warnings()
        return {"FINISHED"}

    def begin(self, context):
        stop_following()
        self.job = PictureJob(context.scene, draft=True)
        if not any(editors()):
            bpy.ops.render.view_show("INVOKE_DEFAULT")

    def tick(self, context):
        done = self.job.tick()
        context.workspace.status_text_set("sparselens: %s; Esc stops" % (
            self.job.chain.progress() or self.job.words))
        return done

    def end(self, context):
        self.job.stop()

    def done(self, context):
        self.say_warnings()
        if context.scene.sparselens.live:
            start_following(self.job.state)

    def say_warnings(self):
        say_warnings(self, self.job)


class SPARSELENS_OT_finish(Renders, bpy.types.Operator):
    """Render two noisy pictures through the lens as it is now, and make the picture exact by them"""

    bl_idname = "sparselens.finish"
    bl_label = "Finish"

    def prepare(self, context):
        settings = context.scene.sparselens
        self.finishing = Finishing(context.scene, manner_of(settings))
        self.steps = self.finishing.steps()

    def so_far(self):
        return ""

    def done(self, context):
        say_warnings(self, self.finishing)
        if context.scene.sparselens.live and not bpy.app.background:
            start_following(lens_state(context.scene))


class SPARSELENS_OT_make_nodes(bpy.types.Operator):
    """Make the node group Sparse lens, which reads the pictures, for the compositor"""

    bl_idname = "sparselens.make_nodes"
    bl_label = "Make Node Group"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            group = nodes.group_of(context.scene)
        except ERRORS as error:
            report(self, "ERROR", error)
            return {"CANCELLED"}
        self.report({"INFO"}, "In the compositor: Add > Group > %s"
                    % group.name)
        return {"FINISHED"}
