"""What the buttons of the node SparselensGather do: command lines of dof-gather and dof-view, run in the background."""

import os
import re
import shlex
import subprocess
import threading
import time

import nuke

PERCENT = re.compile(r"dof-gather: (\d+)%")  # lines of --progress plain

# Knobs that give an option, if they are not at the value that changes nothing.
LOOKS = {"blades": 0, "blade_rotation": 0, "squeeze": 1, "cat_eye": 0, "spherical": 0}


def keyed(knob, frames):
    """The value of a knob; if it is animated, FRAME:VALUE for each frame."""
    if not knob.isAnimated():
        return repr(knob.value())
    if len(frames) == 1:
        return repr(knob.valueAt(frames[0]))
    return ",".join(f"{frame}:{knob.valueAt(frame)!r}" for frame in frames)


def name_of(node, knob):
    """The name as it is typed: dof-gather itself puts in the frames."""
    name = node[knob].value()
    if not name:
        raise ValueError(f"{node.name()}: {knob} is empty")
    return name


def tool(node, name):
    folder = node["tools"].value()
    return os.path.join(folder, name) if folder else name


def lens_options(node, frames):
    options = []
    if node["own_focus"].value():
        options += ["--focus-distance", keyed(node["focus_distance"], frames)]
    if node["own_fstop"].value():
        options += ["--fstop", keyed(node["fstop"], frames)]
    for name, nothing in LOOKS.items():
        knob = node[name]
        if knob.isAnimated() or knob.value() != nothing:
            options += ["--" + name.replace("_", "-"), keyed(knob, frames)]
    return options + ["--quality", node["quality"].value()] + shlex.split(node["options"].value())


def gather_command(node):
    first, last = int(node["first"].value()), int(node["last"].value())
    if last < first:
        raise ValueError(f"{node.name()}: the last frame is before the first")
    frames = range(first, last + 1)
    return [tool(node, "dof-gather"), name_of(node, "ldi"), "-o", name_of(node, "output"), "--frames", f"{first}-{last}",
            "--progress", "plain"] + lens_options(node, frames)


def view_command(node):
    """dof-view shows one LDI, here that of the current frame, and its page changes the lens."""
    frame = int(nuke.frame())
    name = re.sub(r"%0?(\d*)d", lambda place: f"{frame:0{place[1] or 1}d}", name_of(node, "ldi"))
    name = re.sub(r"#+", lambda place: f"{frame:0{len(place[0]) if len(place[0]) > 1 else 4}d}", name)
    return [tool(node, "dof-view"), name, "--open"] + lens_options(node, [frame])


def run(command, title, done):
    """Runs the command, shows its progress, and ends it if the user cancels."""
    task = nuke.ProgressTask(title)
    said = []
    try:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        return nuke.executeInMainThread(nuke.message, args=(f"{command[0]}: {error.strerror}",))

    def watch():  # a tool that computes says nothing for a while
        while process.poll() is None:
            if task.isCancelled():
                process.terminate()
            time.sleep(0.1)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    for line in process.stderr:
        percent = PERCENT.match(line)
        if percent:
            task.setProgress(int(percent[1]))
        else:
            said = (said + [line.rstrip()])[-5:]
    code = process.wait()
    watcher.join()
    if code and not task.isCancelled():
        return nuke.executeInMainThread(nuke.message, args=("\n".join(said) or f"{command[0]}: exit code {code}",))
    if not code:
        nuke.executeInMainThread(done)


def gather(node):
    """Gathers in the background, then shows the pictures. Returns the thread; None if the knobs are wrong."""
    try:
        command = gather_command(node)
    except ValueError as error:
        return nuke.message(str(error))
    thread = threading.Thread(target=run, args=(command, node.name(), node.node("picture")["reload"].execute))
    thread.start()
    return thread


def view(node):
    """Opens dof-view, which serves its page until Nuke ends."""
    try:
        return subprocess.Popen(view_command(node))
    except (OSError, ValueError) as error:
        return nuke.message(str(error))
