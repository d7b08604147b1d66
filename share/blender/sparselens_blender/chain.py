"""Runs the tools one after the other, without blocking Blender."""

import os
import re
import subprocess
import tempfile
import time

# Without it, Windows would open a window for each program.
NO_WINDOW = {"creationflags": getattr(subprocess, "CREATE_NO_WINDOW", 0)}


class ToolError(RuntimeError):
    """A tool failed; the message is what it said."""


def kind_of(warning):
    """The kind of a warning: its text without files and numbers."""
    return re.sub(r"\S*\.exr|\d[\d.,]*", "", warning)


class Once:
    """Says one warning of each kind, and at the end how many more there
    were."""

    def __init__(self, say):
        self.say, self.kinds, self.more = say, set(), 0

    def __call__(self, text):
        if kind_of(text) in self.kinds:
            self.more += 1
            return
        self.kinds.add(kind_of(text))
        self.say(text)

    def end(self):
        if self.more:
            self.say("%d more like these, of other files" % self.more)
        self.more = 0


PERCENT = re.compile(r"[\w-]+: \d+%")


class Chain:
    """Commands of sparselens that run one after the other, each after the
    success of the one before. Their outputs appear whole or not at all, so the
    chain can be stopped at any time."""

    def __init__(self, commands):
        self.left = list(commands)
        self.process = self.said = None
        self.warnings, self.began, self.seconds = [], 0, 0  # of the last one

    def poll(self):
        """Returns whether all is done. Raises ToolError if a tool has
        failed."""
        if self.process is None:
            return not self.begin()
        if self.process.poll() is None:
            return False
        self.end()
        return not self.begin()

    def begin(self):
        if not self.left:
            return False
        command = self.left.pop(0)
        self.said, self.began = tempfile.TemporaryFile(), time.monotonic()
        try:
            self.process = subprocess.Popen(
                command + ["--progress", "plain"], stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL, stderr=self.said, **NO_WINDOW)
        except OSError as error:
            self.said.close()
            raise ToolError("%s cannot be run: %s"
                            % (command[0], error.strerror)) from error
        return True

    def end(self):
        process, self.process = self.process, None
        self.seconds = time.monotonic() - self.began
        with self.said as said:
            said.seek(0)
            lines = [line for line
                     in said.read().decode(errors="replace").splitlines()
                     if not PERCENT.fullmatch(line)]
        self.warnings += [line for line in lines if ": warning: " in line]
        if process.returncode != 0:
            self.left = []
            errors = [line for line in lines if ": warning: " not in line]
            if process.returncode < 0 and process.returncode != -9:  # memory
                errors = ["%s crashed, which is a fault of sparselens: %s" % (
                    os.path.basename(process.args[0]),
                    " ".join(errors) or "signal %d" % -process.returncode)]
            raise ToolError("\n".join(errors) or "%s ended with %d" % (
                process.args[0], process.returncode))

    def progress(self):
        """How far the running command is, such as "dof-gather: 42%". It shares
        its end in the file, which must stay."""
        if self.process is None or not hasattr(os, "pread"):  # Windows
            return ""
        file = self.said.fileno()
        said = os.pread(file, os.fstat(file).st_size, 0).decode(
            errors="replace")
        return (PERCENT.findall(said) or [""])[-1]

    def wait(self):
        """Prints the progress of long commands."""
        told = ""
        while not self.poll():
            try:
                self.process.wait(timeout=2)
            except subprocess.TimeoutExpired:
                if self.progress() != told:
                    told = self.progress()
                    print("sparselens:", told, flush=True)

    def stop(self):
        """Ends the running command, and begins no more."""
        self.left = []
        if self.process is None:
            return
        self.process.terminate()
        try:
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process = None
        self.said.close()
