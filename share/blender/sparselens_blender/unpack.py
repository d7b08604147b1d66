"""Unpacks the archive of the tools, which tools/bundle.sh makes, for the
add-on."""

import glob
import lzma
import os
import re
import shutil
import tarfile
import tempfile

TOP = re.compile(r"sparselens-[\w.-]+")


def top_of(archive, path):
    """The archive's only folder. Raises ValueError if the archive holds
    anything but files and folders in it."""
    tops = set()
    for member in archive:
        parts = member.name.split("/")
        if (".." in parts or not TOP.fullmatch(parts[0])
                or not (member.isfile() or member.isdir())):
            raise ValueError("%s is not an archive of sparselens' tools: it "
                             "has '%s'" % (path, member.name))
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
        with tarfile.open(path) as archive:
            top = top_of(archive, path)
            made = tempfile.mkdtemp(prefix=".new-", dir=folder)
            try:
                archive.extractall(made)
                check(os.path.join(made, top, "bin"))
                for old in folders_unpacked(folder):
                    shutil.rmtree(os.path.dirname(old))
                os.replace(os.path.join(made, top), os.path.join(folder, top))
            finally:
                shutil.rmtree(made)
    except (tarfile.TarError, EOFError, lzma.LZMAError) as error:
        raise ValueError("%s is not an archive, or not a whole one: choose "
                         "sparselens-VERSION-linux-x86_64.tar.xz"
                         % path) from error
    return os.path.join(folder, top, "bin")
