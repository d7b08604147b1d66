"""Unpacks the archive of the tools, which tools/bundle.sh and
tools/windows.sh make, for the add-on."""

import glob
import lzma
import os
import platform
import re
import shutil
import tarfile
import tempfile
import zipfile

TOP = re.compile(r"sparselens-[\w.-]+")
ENDING = ".zip" if os.name == "nt" else ".tar.xz"
# The archive for this machine. Windows on ARM runs programs for x86-64.
ARCHIVE = "sparselens-VERSION-" + (
    "windows-x86_64" if os.name == "nt"
    else "linux-" + platform.machine()) + ENDING


def opened(path):
    """The archive, and the names of its files and folders. The names of
    other members begin with "link "."""
    if zipfile.is_zipfile(path):
        archive = zipfile.ZipFile(path)
        return archive, archive.namelist()  # a link is taken as a file
    archive = tarfile.open(path)
    return archive, [member.name if member.isfile() or member.isdir()
                     else "link " + member.name for member in archive]


def top_of(names, path):
    """The archive's only folder. Raises ValueError if the archive holds
    anything but files and folders in it."""
    tops = set()
    for name in names:
        parts = name.split("/")
        if ".." in parts or not TOP.fullmatch(parts[0]):
            raise ValueError("%s is not an archive of sparselens' tools: it "
                             "has '%s'" % (path, name))
        tops.add(parts[0])
    if len(tops) != 1:
        raise ValueError("%s is not an archive of sparselens' tools: it has "
                         "%d folders" % (path, len(tops)))
    return tops.pop()


def folders_unpacked(place):
    """The folders bin of archives that are unpacked in this place, the newest
    version first."""
    return sorted(glob.glob(os.path.join(glob.escape(place), "sparselens-*",
                                         "bin")), reverse=True)


def unpack(path, folder, check):
    """Unpacks the archive into the folder, in the place of earlier ones.
    Returns the folder of the tools. Nothing changes if check(folder) raises
    an exception, because they do not run."""
    try:
        archive, names = opened(path)
        with archive:
            top = top_of(names, path)
            made = tempfile.mkdtemp(prefix=".new-", dir=folder)
            try:
                archive.extractall(made)
                check(os.path.join(made, top, "bin"))
                for old in folders_unpacked(folder):
                    shutil.rmtree(os.path.dirname(old))
                os.replace(os.path.join(made, top), os.path.join(folder, top))
            finally:
                shutil.rmtree(made)
    except (tarfile.TarError, zipfile.BadZipFile, EOFError,
            lzma.LZMAError) as error:
        raise ValueError("%s is not an archive, or not a whole one: choose %s"
                         % (path, ARCHIVE)) from error
    return os.path.join(folder, top, "bin")
