"""The package sparselens. The compiled module _sparselens has everything except view() and Viewing."""
try:
    from ._sparselens import *  # noqa: F403: all of it
except ImportError as error:
    if "cannot open shared object file" not in str(error):
        raise
    raise ImportError(f"{error}: sparselens needs the OpenEXR, OpenColorIO, oneTBB and fmt that it was built with; "
                      "install them (docs/python.md), or build it again") from None
from ._sparselens import __doc__, __version__
from ._viewing import Viewing, view

__all__ = [name for name in dir() if not name.startswith("_")]
for _name in __all__:  # help() and messages name the package, not the file
    globals()[_name].__module__ = "sparselens"
