"""Operators work at once if there is no window; otherwise bit by bit on a
timer, until all is done or Esc is pressed.
"""

from contextlib import ExitStack

import bpy

from .chain import Chain
from .temporary_settings import changed
from .render_job import ERRORS
from .words import report


at_work = []  # the operator on the timer; no other may begin meanwhile


class Stopped(Exception):
    """The user pressed Esc."""


last_keys = []  # the last two keys or buttons, pressed or released


class SPARSELENS_OT_note_keys(bpy.types.Operator):
    """Note the last keys that were pressed"""

    bl_idname = "sparselens.note_keys"
    bl_label = "Note Keys"
    bl_options = {"INTERNAL"}

    def invoke(self, context, event):
        last_keys[:] = event.type, event.type_prev
        return {"CANCELLED"}


def esc_is_last():
    """Whether Esc is among the last keys, even if nothing has handled it."""
    bpy.ops.sparselens.note_keys("INVOKE_DEFAULT")
    return "ESC" in last_keys


class Chunked:
    """An operator with begin(context); tick(context), which returns whether
    all is done; and end(context), which is called however it ends."""

    timer = None
    stopped = False
    holds = False  # blocks keys and buttons, which could undo changes

    @classmethod
    def poll(cls, context):
        return not at_work

    def may_stop(self):
        return True

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        try:
            self.begin(context)
        except ERRORS as error:
            report(self, "ERROR", error)
            return {"CANCELLED"}
        manager = context.window_manager
        self.timer = manager.event_timer_add(0.05, window=context.window)
        manager.modal_handler_add(self)
        at_work.append(self.bl_idname)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        self.stopped |= event.type == "ESC" and event.value == "PRESS"
        if event.type != "TIMER":
            pressed = event.value in {"PRESS", "CLICK", "DOUBLE_CLICK"}
            return {"RUNNING_MODAL" if self.holds and pressed
                    else "PASS_THROUGH"}
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
            report(self, "ERROR", error)
            return {"CANCELLED"}
        except Exception:
            self.cancel(context)
            raise
        self.cancel(context)
        self.done(context)
        return {"FINISHED"}

    def cancel(self, context):
        """Blender also calls this when it ends the operator."""
        at_work.clear()
        self.end(context)
        if self.timer is not None:
            context.window_manager.event_timer_remove(self.timer)
            self.timer = None
        context.workspace.status_text_set(None)


class Rendering:
    """Steps that render, in Blender's own time, with tools between them."""

    def __init__(self, scene, steps):
        self.scene, self.steps = scene.name, steps
        self.words, self.chain, self.stopped = "", None, False
        self.esc = True  # until another key is pressed
        self.around = ExitStack()

    def begin(self):
        """Locks the scene and its windows against changes meanwhile."""
        self.around.enter_context(changed(
            bpy.context.preferences.view, render_display_type="NONE"))
        self.around.enter_context(changed(
            bpy.data.scenes[self.scene].render, use_lock_interface=True))
        bpy.app.handlers.render_cancel.append(self.note_stop)
        self.around.callback(bpy.app.handlers.render_cancel.remove,
                             self.note_stop)

    def note_stop(self, *_):
        self.stopped = True

    def is_esc_new(self):
        """Whether Esc was pressed since the last step. From the end of a
        render to the next turn of Blender's timer for jobs, .2 s, Blender
        takes Esc but stops nothing."""
        before, self.esc = self.esc, esc_is_last()
        return self.esc and not before

    def tick(self):
        """Begins the next step if none runs. Returns whether all are done."""
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
        if self.is_esc_new():
            raise Stopped
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
