"""Presses the add-on's buttons in a window, as a person does, and fails if something is wrong.

    blender SCENE.blend -P window.py -- FOLDER VIEWS [SCREENSHOT.png]
"""

import os
import sys
import traceback

import bpy

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from keyboard import esc_at_end_of, press_key  # noqa: E402
from state import changes, state  # noqa: E402


def check(true, text):
    if not true:
        raise AssertionError(text)


def main_window():
    return bpy.context.window_manager.windows[0]


def press(operator):
    with bpy.context.temp_override(window=main_window()):
        check(operator("INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "%s does not run on" % operator)


def until(true, what):
    """Waits for 2000 steps: ten times as long as a slow machine needs. The steps, too, are slower on a busy machine."""
    for _ in range(2000):
        if true():
            return
        yield
    check(False, "waited for %s" % what)


def undo(*steps):
    """Pushes these steps, then undoes one."""
    with bpy.context.temp_override(window=main_window()):
        for step in steps:
            bpy.ops.ed.undo_push(message=step)
        bpy.ops.ed.undo()


def idle():
    return bpy.context.scene.camera.name == "Camera" and not bpy.app.is_job_running("RENDER")


def same(before, what):
    found = changes(before, state(bpy.context.scene))
    check(not found, "%s changed %s" % (what, found[:20]))


def files_in(folder):
    return {os.path.relpath(os.path.join(parent, name), folder) for parent, _, names in os.walk(folder) for name in names}


def stop_by_esc(addon, operator, folder, wait, end_of):
    """Presses the button, and Esc after some steps, or at the end of a render. Returns the new files."""
    picture = os.path.join(folder, "picture.exr")
    before, files, first = state(bpy.context.scene), files_in(folder), os.path.getmtime(picture)
    press_key("Shift_L")  # something is pressed before the button
    yield
    if end_of:
        esc_at_end_of(end_of)
    press(operator)
    yield from until(lambda: bpy.app.is_job_running("RENDER"), "a render")
    if not end_of:
        for _ in range(wait):
            yield
        press_key("Esc")
    yield from until(lambda: idle() and not addon.chunked.at_work, "the render to stop")
    yield
    what = "Esc during %s, %s" % (operator.idname(), "render %d" % end_of if end_of else "step %d" % wait)
    same(before, what)
    found = files_in(folder) - files
    check(os.path.getmtime(picture) == first, "%s: there is another picture" % what)
    return found


def taken():
    return next((image for image in bpy.data.images if image.get("sparselens")), None)


def shown():
    return {area.spaces.active.image for window in bpy.context.window_manager.windows
            for area in window.screen.areas if area.type == "IMAGE_EDITOR"}


forbidden = []  # what happened where Blender forbids writes


def write_while_drawing(addon):
    """Blender's flag may stay set after a render: drawing sets it too."""
    scene = bpy.context.scene

    def write():
        scene.render.film_transparent = scene.render.film_transparent

    def draw(*_):
        bpy.types.PROPERTIES_HT_header.remove(draw)
        try:
            write()
            forbidden.append("Blender does not forbid it")
        except AttributeError:
            addon.write_access.with_write_access(write)
            forbidden.append("written")

    bpy.types.PROPERTIES_HT_header.append(draw)


def steps(addon, folder, screenshot):
    scene = bpy.context.scene
    bpy.context.view_layer.objects.active = scene.camera
    yield
    area = next(area for area in main_window().screen.areas if area.type == "PROPERTIES")
    area.spaces.active.context = "DATA"
    scene.sparselens.finish = 8
    yield from until(lambda: forbidden, "a header that is drawn")
    check(forbidden == ["written"], "while a header was drawn: %s" % forbidden)
    before = state(scene)

    # Esc during the second view: rendered views stay, and the scene is unchanged.
    press(bpy.ops.sparselens.render_views)
    yield from until(lambda: os.path.exists(os.path.join(folder, "center.exr")) and bpy.app.is_job_running("RENDER"), "the second view")
    for other in bpy.ops.sparselens.render_views, bpy.ops.sparselens.take_picture, bpy.ops.sparselens.finish, bpy.ops.sparselens.render_animation:
        check(not other.poll(), "%s can begin meanwhile" % other)
    press_key("Esc")
    yield from until(idle, "the render to stop")
    yield
    same(before, "Esc")
    check(os.listdir(folder) == ["center.exr"], "Esc left %s" % os.listdir(folder))
    scene.cycles.samples = 4  # 32 are for Esc
    before = state(scene)

    press(bpy.ops.sparselens.render_views)
    yield from until(lambda: idle() and os.path.exists(os.path.join(folder, "view_3.exr")), "the views")
    yield
    same(before, "Render Views")
    check(len(os.listdir(folder)) == 5, "rendered were %s" % os.listdir(folder))

    # Esc during Take Picture leaves whole files.
    press(bpy.ops.sparselens.take_picture)
    press_key("Esc")
    yield from until(lambda: idle() and not addon.chunked.at_work, "Take Picture to stop")
    yield
    same(before, "Esc during Take Picture")
    check(not [name for name in os.listdir(folder) if "partial" in name], "Esc left %s" % os.listdir(folder))

    # Undo takes the picture back, and nothing else. Blender's own undo changes a scene when it happens first.
    undo("begin", "more")
    yield
    scene = bpy.context.scene
    before = state(scene)
    press(bpy.ops.sparselens.take_picture)
    path = os.path.join(folder, "picture.exr")
    yield from until(lambda: taken() and taken().filepath == path and addon.render_job.follower, "the picture")
    same(before, "Take Picture")
    check(taken() in shown(), "no image editor shows the picture")
    undo()
    yield
    scene = bpy.context.scene
    same(before, "Take Picture, undone,")

    # Esc whenever it comes, ten times in a row: what was rendered stays, and the rest is as before.
    finish, animation = bpy.ops.sparselens.finish, bpy.ops.sparselens.render_animation
    scene.render.filepath = os.path.join(folder, "shot")
    for operator, samples, wait, end_of, left in (
            *[(finish, 1024, wait, None, set()) for wait in range(4)],
            (finish, 2, None, 1, {"rays_1.exr"}), (finish, 2, None, 1, set()),
            *[(animation, 1024, wait, None, set()) for wait in range(2)],
            (animation, 4, None, 1, set()), (animation, 4, None, 4, {"frames/center.0001.exr"})):
        scene.cycles.samples, scene.sparselens.finish = samples, 4 * samples
        scene.sparselens.folder = os.path.join(folder, "frames") if operator is animation else folder
        found = yield from stop_by_esc(addon, operator, folder, wait, end_of)
        check(found == left, "Esc left %s" % found)
    scene.cycles.samples, scene.sparselens.finish, scene.sparselens.folder = 4, 8, folder
    first = os.path.getmtime(path)
    before = state(scene)

    # Two renders through the lens finish the picture; then the lens is followed again.
    press(bpy.ops.sparselens.finish)
    check(addon.render_job.follower is None, "a lens is followed while it is rendered")
    yield from until(lambda: idle() and os.path.getmtime(path) > first and addon.render_job.follower, "the finished picture")
    same(before, "Finish")
    check(taken().filepath == path and taken() in shown(), "no image editor shows the finished picture")
    first = os.path.getmtime(path)

    # A field changes: a draft, and the picture.
    paths, image_of = [], addon.render_job.image_of
    addon.render_job.image_of = lambda scene, eye, path: paths.append(path) or image_of(scene, eye, path)
    scene.camera.data.dof.focus_distance = 2
    yield from until(lambda: path in paths and os.path.getmtime(path) > first, "the picture of another focus")
    check([other == path for other in paths] == [False, True], "a draft and then the picture: %s" % paths)
    check(": warning: " in (addon.render_job.follower.message or ": warning: "), addon.render_job.follower.message)

    # Undo removes the image; the next change restores it.
    undo("focus")
    undo()
    yield
    before = os.path.getmtime(path)
    bpy.context.scene.camera.data.dof.focus_distance = 3
    yield from until(lambda: os.path.getmtime(path) > before and taken() and taken().filepath == path and taken() in shown(),
                     "the picture after undo")
    scene = bpy.context.scene

    # A tool's message about a wrong look is shown in the panel.
    scene.sparselens.looks = "--spherical 7"
    yield from until(lambda: "--spherical" in addon.render_job.follower.message, "dof-gather's own words")
    if screenshot:
        with bpy.context.temp_override(window=main_window(), area=area):
            bpy.ops.screen.screen_full_area()
        yield
        yield
        with bpy.context.temp_override(window=main_window()):
            bpy.ops.screen.screenshot(filepath=screenshot)


def main(path, folder, screenshot=None):
    sys.path.insert(0, path)
    import sparselens_blender as addon
    addon.register()
    scene = bpy.context.scene
    scene.cycles.samples = 32
    scene.sparselens.folder = folder
    write_while_drawing(addon)
    running = steps(addon, folder, screenshot)

    def step():
        try:
            if addon.write_access.with_write_access(lambda: next(running, "done")) != "done":
                return 0.1
            addon.write_access.with_write_access(addon.panel.unregister)
            check(addon.render_job.follower is None, "it follows without an add-on")
            print("window.py: all is as it should be", flush=True)
            os._exit(0)
        except Exception:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)

    bpy.app.timers.register(step, first_interval=1)


main(*sys.argv[sys.argv.index("--") + 1:])
