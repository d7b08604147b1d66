"""Finds the tools that make pictures of views: ldi-warp, dof-gather."""

import glob
import importlib.metadata
import os
import shutil
import subprocess

import bpy

from .chain import NO_WINDOW
from .unpack import ARCHIVE, ENDING as ARCHIVE_ENDING
from .unpack import folders_unpacked, unpack

HERE = os.path.dirname(os.path.realpath(__file__))
ENDING = ".exe" if os.name == "nt" else ""
NAMES = "ldi-warp", "dof-gather"


class NoTool(ValueError):
    """A tool is not found; the message says where it was searched."""


def folder_of_archives():
    """Where Install Tools unpacks: the extension's own folder, else one of
    Blender's."""
    if __package__.startswith("bl_ext."):
        return bpy.utils.extension_path_user(__package__, create=True)
    return bpy.utils.user_resource("DATAFILES", path="sparselens",
                                   create=True)


def folders_installed():
    """What Install Tools unpacked; before that, the archive that came in the
    add-on's own zip, unless a newer one is installed."""
    place = folder_of_archives()
    for archive in glob.glob(os.path.join(
            glob.escape(HERE), ARCHIVE.replace("VERSION", "*"))):
        name = os.path.basename(archive)[:-len(ARCHIVE_ENDING)]
        if os.path.join(place, name, "bin") > max(folders_unpacked(place),
                                                  default=""):
            try:
                unpack(archive, place, version)
            except (OSError, ValueError):
                pass  # another Blender has unpacked it, or there is no room
    return folders_unpacked(place)


def folders_beside():
    """The folder bin inside the add-on, archives that are unpacked in the
    add-on or beside it, and the installation that contains the add-on:
    PREFIX/share/sparselens/blender/sparselens_blender."""
    yield os.path.join(HERE, "bin")
    yield from folders_unpacked(HERE)
    yield from folders_unpacked(os.path.dirname(HERE))
    yield os.path.normpath(os.path.join(HERE, *[os.pardir] * 4, "bin"))


def folders_of_pip():
    """The folder where pip put the tools, for Blender's Python."""
    try:
        files = importlib.metadata.files("sparselens") or []
    except importlib.metadata.PackageNotFoundError:
        return
    for file in files:
        if file.name == NAMES[1] + ENDING:
            yield str(file.locate().resolve().parent)


def folders_on_path():
    found = shutil.which(NAMES[1])
    if found:
        yield os.path.dirname(found)


def candidates(chosen):
    """Pairs (folder, its description), best first. A folder from the
    preferences is the only candidate."""
    if chosen:
        yield os.path.expanduser(chosen), "the chosen folder"
        return
    for found, where in ((folders_installed, "installed"),
                         (folders_beside, "beside the add-on"),
                         (folders_of_pip, "in pip's package"),
                         (folders_on_path, "on the PATH")):
        for folder in found():
            yield folder, where


def has_tools(folder):
    return all(os.access(os.path.join(folder, name + ENDING), os.X_OK)
               for name in NAMES)


def find(chosen=""):
    """The folder of the tools, and its description."""
    for folder, where in candidates(chosen):
        if has_tools(folder):
            return folder, where
    if chosen:
        raise NoTool("the folder '%s' does not have ldi-warp and dof-gather: "
                     "choose the one of sparselens' tools" % chosen)
    raise NoTool("ldi-warp and dof-gather are not found, neither beside the "
                 "add-on nor in pip's package nor on the PATH: press Install "
                 "Tools in the add-on's preferences, or name their folder "
                 "there (or on the command line by --tools)")


def tool(folder, name):
    return os.path.join(folder, name + ENDING)


def version(folder):
    """The version line of dof-gather."""
    command = [tool(folder, "dof-gather"), "--version"]
    try:
        done = subprocess.run(command, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=60,
                              **NO_WINDOW)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoTool("%s cannot be run: %s" % (command[0], error)) from error
    if done.returncode != 0:
        raise NoTool("%s cannot be run: %s" % (
            command[0], (done.stderr.strip() or "no reason given")))
    return done.stdout.strip()
