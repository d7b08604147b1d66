"""What Blender loads of the extension that blender_manifest.toml describes."""

from .sparselens_views import register, unregister  # noqa: F401
