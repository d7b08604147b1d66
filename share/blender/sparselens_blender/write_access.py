"""Write access to the scene for callbacks of timers.

Blender has one flag for all threads that forbids writes while a panel is
drawn. If a render's thread sets and restores it meanwhile, it can remain set,
and from then on no timer can write in this session (bpy_class_call() in
Blender's bpy_rna.cc). Blender allows writes in the update function of a
property, whatever the flag, and allows to set properties of the window
manager.
"""

import bpy

tasks = []


def run_task(_, __):
    """Blender prints errors of update functions: this one keeps its own."""
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
