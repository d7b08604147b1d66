"""view() starts dof-view, which serves a page on this machine, for a notebook or a script."""
import atexit
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from . import _sparselens


class Viewing:
    """A running dof-view. It ends when close() is called, at the end of a `with` block, or with the program."""

    def __init__(self, command, folder):
        self._folder = folder
        self._messages = open(os.path.join(folder.name, "messages"), "w+")
        self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=self._messages, text=True)
        atexit.register(self.close)
        self._address = self._process.stdout.readline().strip()
        if self._address:
            return
        code = self._process.wait()
        self._messages.seek(0)
        said = self._messages.read().strip()
        self.close()
        raise (_sparselens.UsageError if code == 2 else _sparselens.Error)(said or f"dof-view ended with code {code}")

    @property
    def address(self):
        """The address to open in a browser on this machine. Anyone who knows it can see the picture."""
        return self._address

    def close(self):
        """Stops the server and removes the files that were written for it."""
        atexit.unregister(self.close)
        if self._process.poll() is None:
            self._process.terminate()
            self._process.wait()
        self._process.stdout.close()
        self._messages.close()
        self._folder.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        return f"<sparselens.Viewing at {self._address}>"

    def _repr_html_(self):
        return f'<a href="{self._address}" target="_blank" rel="noreferrer">dof-view</a>'


def _program():
    """Returns the path of the dof-view that was installed or built with this module, else of the first one in $PATH."""
    here = pathlib.Path(__file__).resolve().parent
    prefix = pathlib.Path(sys.prefix)
    for path in (here.parents[1] / "bin/dof-view", prefix / "bin/dof-view", prefix / "Scripts/dof-view.exe"):
        if path.is_file():
            return str(path)
    found = shutil.which("dof-view")
    if not found:
        raise _sparselens.Error("dof-view is not installed beside the module, nor found in $PATH")
    return found


def _word(value):
    if isinstance(value, (tuple, list)):
        return ",".join(map(str, value))
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def view(ldi, *, open=False, **options):
    """view(ldi, *, open=False, **options) -> Viewing

    Starts dof-view, which serves a page that shows the lens picture; a click on it focuses.

    ldi: an Ldi, or the name of a file or of a file sequence.
    open: whether to open the page in the browser.
    The other keywords are dof-view's options: fstop=2, save="folder", cat_eye_darkening=True.

    Raises UsageError or Error with dof-view's message."""
    command, folder = [_program()], tempfile.TemporaryDirectory(prefix="sparselens-")
    try:
        if isinstance(ldi, _sparselens.Ldi):
            path = os.path.join(folder.name, "ldi.exr")
            _sparselens.write(path, ldi)
        elif isinstance(ldi, (str, os.PathLike)):
            path = os.fspath(ldi)
        else:
            raise TypeError(f"ldi: must be an Ldi or the name of a file, not {type(ldi).__name__}")
        command.append(path)
        for name, value in {**options, "open": open}.items():
            if value is True:
                command.append("--" + name.replace("_", "-"))
            elif value is not None and value is not False:
                command.append(f"--{name.replace('_', '-')}={_word(value)}")
        return Viewing(command, folder)
    except BaseException:
        folder.cleanup()
        raise
