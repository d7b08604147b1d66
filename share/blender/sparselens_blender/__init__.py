"""The Blender add-on and extension; blender_manifest.toml describes the
extension."""

bl_info = {
    "name": "sparselens",
    "author": "sparselens",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Camera > sparselens",
    "description": "Depth of field of a few views: renders them, and takes "
                   "the picture",
    "category": "Render",
}

import bpy  # noqa: E402

from . import command, panel, write_access  # noqa: E402

commands = []  # on Blender's own command line, since 4.2


def register():
    write_access.register()
    panel.register()
    if hasattr(bpy.utils, "register_cli_command"):
        commands.append(bpy.utils.register_cli_command(
            "sparselens", command.run_as_command))


def unregister():
    for made in commands:
        bpy.utils.unregister_cli_command(made)
    commands.clear()
    panel.unregister()
    write_access.unregister()
