"""The add-on of Blender, and its extension, which blender_manifest.toml
describes."""

bl_info = {
    "name": "sparselens views",
    "author": "sparselens",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Camera > sparselens",
    "description": "Renders the views that sparselens makes depth of field of",
    "category": "Render",
}

from .panel import register, unregister  # noqa: E402,F401
