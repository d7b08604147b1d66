"""Renders what sparselens needs of a Blender scene: the centre view and views
from the rim of the lens.

As a script:
    blender -b shot.blend -P sparselens_views.py -- -o DIR [--help]
It needs the folder sparselens_blender beside it, which is also the add-on;
README.md says how to install it, and what is written.

Each view is a pinhole picture. It is rendered through a camera that this
script makes. That camera stands where the scene's camera stands at the frame,
moved in the plane of the lens by the radius of the lens, focal length / (2
f-number). Nothing animates the made camera, so the render cannot move it; the
scene's own camera is only read, after keys, drivers and constraints have been
evaluated. Works with Cycles and EEVEE.
"""

import os
import sys

import bpy

FOLDER = os.path.dirname(os.path.realpath(__file__))


def main():
    if not os.path.isdir(os.path.join(FOLDER, "sparselens_blender")):
        print("sparselens_views.py: error: the folder sparselens_blender is "
              "not beside it, in %s: copy both" % FOLDER, file=sys.stderr)
        sys.exit(1)
    sys.path.insert(0, FOLDER)
    if bpy.app.background or "--" in sys.argv:
        from sparselens_blender.command import run_as_script
        run_as_script()
    else:
        from sparselens_blender import panel
        panel.register()  # not the command, which Blender 4.2 has to end


if __name__ == "__main__":
    main()
