"""What the buttons do: at once where there is no window, and otherwise bit by
bit on a timer, until all is done or Esc is pressed.
"""

import os
from contextlib import ExitStack
from types import SimpleNamespace

import bpy

from . import tools
from .chain import Chain
from .for_a_while import changed
from .renders import AUTO, Count, Manner, folder_of, render_now, views_steps
from .sequence import Pictures
from .shots import eyes_of
from .taking import (
    ERRORS, Taking, chosen_folder, editors, start_following, stop_following)
from .views import views_of_lens


class Stopped(Exception):
    """Esc was pressed."""


class BitByBit:
    """An operator that has begin(context), tick(context), which says whether
    all is done, and end(context), which is called however it ends."""

    timer = None
    stopped = False

    def may_stop(self):
        return True

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        try:
            self.begin(context)
        except ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        manager = context.window_manager
        self.timer = manager.event_timer_add(0.05, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        self.stopped |= event.type == "ESC" and event.value == "PRESS"
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            if self.stopped and self.may_stop():
                raise Stopped
            if not self.tick(context):
                return {"PASS_THROUGH"}
        except Stopped:
            self.cancel(context)
            self.report({"INFO"}, "Stopped")
            return {"CANCELLED"}
        except ERRORS as error:
            self.cancel(context)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.cancel(context)
        self.done(context)
        return {"FINISHED"}

    def cancel(self, context):
        """Blender calls this, too, where it ends the operator."""
        self.end(context)
        if self.timer is not None:
            context.window_manager.event_timer_remove(self.timer)
            self.timer = None
        context.workspace.status_text_set(None)


class Rendering:
    """Steps that render, in Blender's own time, and between them tools."""

    def __init__(self, scene, steps):
        self.scene, self.steps = scene.name, steps
        self.words, self.chain, self.stopped = "", None, False
        self.around = ExitStack()

    def begin(self):
        """Keeps hands and windows off the scene meanwhile."""
        self.around.enter_context(changed(
            bpy.context.preferences.view, render_display_type="NONE"))
        self.around.enter_context(changed(
            bpy.data.scenes[self.scene].render, use_lock_interface=True))
        bpy.app.handlers.render_cancel.append(self.note_stop)
        self.around.callback(bpy.app.handlers.render_cancel.remove,
                             self.note_stop)

    def note_stop(self, *_):
        self.stopped = True

    def tick(self):
        """Begins the next step where none runs. Whether all are done."""
        if bpy.app.is_job_running("RENDER"):
            return False
        if self.stopped:
            raise Stopped
        if self.chain is not None and not self.chain.poll():
            return False
        self.chain = None
        step = next(self.steps, None)
        if step is None:
            return True
        if isinstance(step, Chain):
            self.words, self.chain = "warping and gathering", step
        else:
            self.words = step
            bpy.ops.render.render("INVOKE_DEFAULT", write_still=True,
                                  scene=self.scene)
        return False

    def end(self):
        if self.chain is not None:
            self.chain.stop()
        self.steps.close()
        self.around.close()


def frames_of(scene):
    return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)


def manner_of(settings):
    return Manner(AUTO if settings.overscan_auto else settings.overscan,
                  settings.multilayer, supersample=settings.supersample)


class Renders(BitByBit):
    """An operator of steps: prepare(context) sets self.steps, self.count and
    self.most, the number of views."""

    def warn(self, text):
        self.report({"WARNING"}, text)

    def execute(self, context):
        try:
            self.prepare(context)
            render_now(context.scene, self.steps)
        except ERRORS as error:
            self.report({"ERROR"}, str(error))
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
        context.workspace.status_text_set(
            "sparselens: %s, %d of %d views; Esc stops" % (
                self.rendering.words, self.count.rendered + self.count.kept,
                self.most))
        return done

    def may_stop(self):
        """A render that runs stops by itself, at the same key."""
        return not bpy.app.is_job_running("RENDER")

    def end(self, context):
        self.rendering.end()


class SPARSELENS_OT_render_views(Renders, bpy.types.Operator):
    """Render the centre view and the views from the rim of the lens"""

    bl_idname = "sparselens.render_views"
    bl_label = "Render Views"

    def prepare(self, context):
        scene, settings = context.scene, context.scene.sparselens
        frames = [scene.frame_current]
        if settings.animation:
            frames = frames_of(scene)
        views, eyes = views_of_lens(settings.views, 0), eyes_of(scene)
        self.folder, self.count = folder_of(settings.folder), Count()
        self.most = len(frames) * len(views) * len(eyes)
        self.steps = views_steps(
            scene, frames, self.folder, lambda frame: views, eyes,
            manner_of(settings), self.count, settings.animation, self.warn)

    def done(self, context):
        self.report({"INFO"}, "%d views in %s" % (self.count.rendered,
                                                  self.folder))


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
            multilayer=settings.multilayer, looks=settings.looks,
            tools=chosen_folder())
        manner = manner_of(settings)
        manner.keep = settings.keep
        eyes, frames = eyes_of(scene), frames_of(scene)
        self.pictures = Pictures(scene, eyes, manner, options, self.warn)
        self.pictures.render_again = ("if more than the lens has changed, "
                                      "switch Keep Views off")
        self.count, self.steps = (self.pictures.count,
                                  self.pictures.steps(frames))
        self.most = len(frames) * (settings.views + 1) * len(eyes)

    def done(self, context):
        self.report({"INFO"}, self.pictures.words())


class SPARSELENS_OT_take_picture(BitByBit, bpy.types.Operator):
    """Make the picture of the views, with the focus and f-stop that the camera has now"""

    bl_idname = "sparselens.take_picture"
    bl_label = "Take Picture"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            self.taking = Taking(context.scene, draft=False)
            self.taking.wait()
        except ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.say_warnings()
        return {"FINISHED"}

    def begin(self, context):
        stop_following()
        self.taking = Taking(context.scene, draft=True)
        if not any(editors()):
            bpy.ops.render.view_show("INVOKE_DEFAULT")

    def tick(self, context):
        done = self.taking.tick()
        context.workspace.status_text_set("sparselens: %s; Esc stops"
                                          % self.taking.words)
        return done

    def end(self, context):
        self.taking.stop()

    def done(self, context):
        self.say_warnings()
        if context.scene.sparselens.live:
            start_following(self.taking.state)

    def say_warnings(self):
        for text in self.taking.warnings:
            self.report({"WARNING"}, text)
        self.report({"INFO"}, "The image editor shows %s"
                    % ", ".join(self.taking.images))


class SPARSELENS_OT_find_tools(bpy.types.Operator):
    """Look for sparselens' tools, and say which version is found where"""

    bl_idname = "sparselens.find_tools"
    bl_label = "Test"

    def execute(self, context):
        try:
            folder, where = tools.find(chosen_folder())
            text = "%s, %s: %s" % (tools.version(folder), where, folder)
        except ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, text)
        return {"FINISHED"}
