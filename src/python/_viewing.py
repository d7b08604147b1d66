"""view(): dof-view, which serves a page on this machine, started for a notebook or a script."""
import atexit
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from . import _sparselens


class Viewing:
    """A dof-view at work. It ends by close(), with a `with` block, or with the program."""

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
        """What a browser of this machine opens. Whoever knows it sees the picture."""
        return self._address

    def close(self):
        """Ends the server, and removes what was written for it."""
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
    """That of the installation or the build that this module is of, else any."""
    here = pathlib.Path(__file__).resolve().parent
    for path in (here.parents[1] / "bin/dof-view", pathlib.Path(sys.prefix) / "bin/dof-view"):
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

    Starts dof-view: a page that shows the picture of the lens, where a click focuses. ldi: an Ldi, or the name of a file or a
    sequence. open: opens the page in the browser, too. The others are dof-view's options: fstop=2, save="folder",
    cat_eye_darkening=True. Raises UsageError or Error with what dof-view says."""
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
