"""The package sparselens: everything in it is in the compiled module."""
from ._sparselens import *  # noqa: F403: all of it
from ._sparselens import __doc__, __version__

__all__ = [name for name in dir() if not name.startswith("_")]
for _name in __all__:  # help() and messages name the package, not the file
    globals()[_name].__module__ = "sparselens"
