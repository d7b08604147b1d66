"""Write access to the scene for callbacks of timers.

Blender forbids writes while a panel is drawn, by one flag for all threads. If
a render's thread sets and restores the flag meanwhile, it can remain set. From
then on, no timer can write in this session (bpy_class_call() in Blender's
bpy_rna.cc). The update function of a property may write in any case, and the
properties of the window manager can be set in any case.
"""

import bpy

tasks = []  # (function, where its result goes)


def run_task(_, __):
    """Keeps the error of the task: Blender would only print it."""
    function, results = tasks.pop()
    try:
        results.append((function(), None))
    except Exception as error:
        results.append((None, error))


def with_write_access(function):
    """Returns what the function returns, and raises what it raises."""
    results = []
    tasks.append((function, results))
    bpy.context.window_manager.sparselens_task = True
    result, error = results[0]
    if error is not None:
        raise error
    return result


def register():
    bpy.types.WindowManager.sparselens_task = bpy.props.BoolProperty(
        update=run_task, options={"HIDDEN", "SKIP_SAVE"})


def unregister():
    del bpy.types.WindowManager.sparselens_task
