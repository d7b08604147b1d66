"""The settings of a scene, their panel in the camera's properties, and the
add-on's preferences.
"""

import textwrap

import bpy

from . import looks, render_job, shutter
from .chunked import SPARSELENS_OT_note_keys
from .operators import (
    SPARSELENS_OT_finish, SPARSELENS_OT_make_nodes,
    SPARSELENS_OT_render_animation, SPARSELENS_OT_render_views,
    SPARSELENS_OT_take_picture, frames_of, views_in)
from .shots import picture_size
from .tool_operators import (
    SPARSELENS_OT_find_tools, SPARSELENS_OT_install_tools)
from .views import counted
from .words import in_panel


SPARSELENS_Looks = type("SPARSELENS_Looks", (bpy.types.PropertyGroup,),
                        {"__annotations__": looks.properties()})


class SPARSELENS_Settings(bpy.types.PropertyGroup):
    folder: bpy.props.StringProperty(
        name="Folder", description="Folder of views, LDIs and picture; "
        "{blend_name} is the name of the file, so that a copy of it has "
        "views of its own", subtype="DIR_PATH",
        default="//views/{blend_name}/")
    views: bpy.props.IntProperty(
        name="Rim Views", description="Views from the rim of the lens",
        default=4, min=0, max=64)
    overscan_auto: bpy.props.BoolProperty(
        name="Auto Overscan", default=True,
        description="Render as many pixels beyond each side as the blur at "
                    "the border of the frame needs")
    overscan: bpy.props.IntProperty(
        name="Overscan", description="Pixels rendered beyond each side",
        default=0, min=0, max=4096, subtype="PIXEL")
    supersample_auto: bpy.props.BoolProperty(
        name="Auto Supersample", default=True,
        description="Render the views of a frame twice as wide and high, with "
                    "a quarter of the samples, where ldi-plan advises it: if "
                    "many pixels are at edges of depth")
    supersample: bpy.props.IntProperty(
        name="Supersample", description="Render N x N pixels for each of the "
        "picture, with 1/N^2 of the samples",
        default=1, min=1, max=16)
    shutter: bpy.props.IntProperty(
        name="Moments of Shutter", description="Render the views at N "
        "moments while the shutter of Motion Blur is open, each with 1/N of "
        "the samples, for a picture with motion blur; 1: a still",
        default=1, min=1, max=shutter.MOST)
    finish: bpy.props.IntProperty(
        name="Rays to Finish", description="Samples per pixel, both together, "
        "of the two renders through the lens that Finish makes",
        default=80, min=2, soft_max=4096)
    finish_where_needed: bpy.props.BoolProperty(
        name="Rays Where Needed", description="Finish renders half of its "
        "rays first, and the others in rectangles where the picture needs "
        "them most")
    finish_frames: bpy.props.BoolProperty(
        name="Finish Frames",
        description="Render Animation finishes its pictures, too")
    slices: bpy.props.IntProperty(
        name="Slices of Volumes", description="Render volumes by themselves, "
        "in N slices of depth (Cycles); 0: with everything else",
        default=0, min=0, max=64)
    layers: bpy.props.StringProperty(
        name="See-Through", description="Objects or collections to render "
        "each as a layer of its own, such as nets and films, separated by "
        "commas")
    multilayer: bpy.props.BoolProperty(
        name="All Passes",
        description="Multilayer EXR with all passes of the view layers")
    animation: bpy.props.BoolProperty(
        name="Animation",
        description="Render the views of all frames of the scene, not only "
                    "of the current one")
    lens_looks: bpy.props.PointerProperty(type=SPARSELENS_Looks)
    looks: bpy.props.StringProperty(
        name="Other Options", description="Further options of dof-gather, "
        "such as --quality final")
    live: bpy.props.BoolProperty(
        name="Live", default=True,
        description="After Take Picture, make the picture anew whenever "
                    "focus, f-stop, blades, ratio or rotation change")
    keep: bpy.props.BoolProperty(
        name="Keep Views",
        description="Render Animation uses existing views if the camera, the "
                    "picture's size and the samples are the same. It does "
                    "not see other changes of the scene")


def gigabytes(scene):
    """Gigabytes of all frames' views and LDIs without compression: 12 bytes
    per pixel of a view, and an LDI is as large as three views."""
    settings, size = scene.sparselens, picture_size(scene.render)
    finest = 2 if settings.supersample_auto else settings.supersample
    pixels = size[0] * size[1] * finest ** 2 * settings.shutter
    return 12e-9 * pixels * (settings.views + 4) * len(frames_of(scene))


def say(layout, text, context):
    """Wraps the text to the width of the panel; about 7 pixels per letter."""
    region = getattr(context, "region", None)
    letters = max(20, region.width // 7 - 6) if region else 60
    for number, line in enumerate(textwrap.wrap(text, letters)):
        layout.label(text=line, icon="BLANK1" if number else "ERROR")


class SPARSELENS_Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    folder: bpy.props.StringProperty(
        name="Folder of the Tools", subtype="DIR_PATH",
        description="Folder of ldi-warp and dof-gather. If empty, the add-on "
                    "searches beside itself, in pip's package, and on the "
                    "PATH")

    def draw(self, context):
        row = self.layout.row()
        row.prop(self, "folder")
        row.operator("sparselens.find_tools")
        self.layout.operator("sparselens.install_tools")


class InCamera:
    """Where the panels are: in the properties of the camera."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"


class SPARSELENS_PT_panel(InCamera, bpy.types.Panel):
    bl_label = "sparselens"

    @classmethod
    def poll(cls, context):
        return context.camera is not None

    def draw(self, context):
        layout, settings = self.layout, context.scene.sparselens
        layout.use_property_split = True
        layout.use_property_decorate = False
        camera = context.scene.camera
        if camera is None or camera.data != context.camera:
            say(layout, "Views are those of the scene's camera, %s" % (
                camera.name if camera else "which is not set"), context)
        layout.prop(settings, "folder")
        layout.prop(settings, "views")
        layout.prop(settings, "overscan_auto")
        if not settings.overscan_auto:
            layout.prop(settings, "overscan")
        layout.prop(settings, "supersample_auto")
        if not settings.supersample_auto:
            layout.prop(settings, "supersample")
        for name in ("shutter", "slices", "layers", "multilayer",
                     "animation"):
            layout.prop(settings, name)
        layout.operator("sparselens.render_views")
        layout.prop(settings, "live")
        layout.operator("sparselens.take_picture")
        if render_job.follower:
            say(layout, in_panel(render_job.follower.message), context)
        layout.prop(settings, "finish")
        layout.prop(settings, "finish_where_needed")
        layout.operator("sparselens.finish")
        layout.prop(settings, "finish_frames")
        layout.prop(settings, "keep")
        layout.operator("sparselens.render_animation")
        layout.label(text="%d frames of %s, up to %.1f GB" % (
            len(frames_of(context.scene)), counted(
                views_in(settings), "render"), gigabytes(context.scene)))
        layout.operator("sparselens.make_nodes")


class SPARSELENS_PT_looks(InCamera, bpy.types.Panel):
    bl_label = "Looks"
    bl_parent_id = "SPARSELENS_PT_panel"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.sparselens
        layout.use_property_split = True
        for name in (*looks.FILES, *[look["name"] for look in looks.ALL]):
            layout.prop(settings.lens_looks, looks.field_of(name))
        layout.prop(settings, "looks")


CLASSES = (SPARSELENS_Looks, SPARSELENS_Settings, SPARSELENS_Preferences,
           SPARSELENS_OT_render_views, SPARSELENS_OT_take_picture,
           SPARSELENS_OT_finish, SPARSELENS_OT_render_animation,
           SPARSELENS_OT_make_nodes, SPARSELENS_OT_note_keys,
           SPARSELENS_OT_find_tools,
           SPARSELENS_OT_install_tools,
           SPARSELENS_PT_panel, SPARSELENS_PT_looks)


def register():
    for made in CLASSES:
        bpy.utils.register_class(made)
    bpy.types.Scene.sparselens = bpy.props.PointerProperty(
        type=SPARSELENS_Settings)
    bpy.app.handlers.load_pre.append(render_job.stop_at_load)


def unregister():
    bpy.app.handlers.load_pre.remove(render_job.stop_at_load)
    render_job.stop_following()
    del bpy.types.Scene.sparselens
    for made in reversed(CLASSES):
        bpy.utils.unregister_class(made)
