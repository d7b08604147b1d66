"""The settings of a scene, their panel in the camera's properties, and the
operator that renders.
"""

import bpy

from .renders import AUTO, render_frames
from .shots import eyes_of
from .views import views_of_lens


class SPARSELENS_Settings(bpy.types.PropertyGroup):
    folder: bpy.props.StringProperty(
        name="Folder", description="Where the views go", subtype="DIR_PATH",
        default="//views/")
    views: bpy.props.IntProperty(
        name="Rim Views", description="Views from the rim of the lens",
        default=4, min=0, max=64)
    overscan: bpy.props.IntProperty(
        name="Overscan", description="Pixels rendered beyond each side",
        default=0, min=0, max=4096, subtype="PIXEL")
    overscan_auto: bpy.props.BoolProperty(
        name="Automatic Overscan",
        description="As many pixels beyond each side as the blur at the "
                    "border needs, at each frame, instead of Overscan")
    supersample: bpy.props.IntProperty(
        name="Supersample", description="Pixels rendered, across and down, "
        "for each of the picture, with as many fewer samples",
        default=1, min=1, max=16)
    multilayer: bpy.props.BoolProperty(
        name="All Passes",
        description="Multilayer EXR with all passes of the view layers")
    animation: bpy.props.BoolProperty(
        name="Animation",
        description="All frames of the scene, else the current one")


class SPARSELENS_OT_render_views(bpy.types.Operator):
    """Render the centre view and the views from the rim of the lens"""

    bl_idname = "sparselens.render_views"
    bl_label = "Render Views"

    def execute(self, context):
        scene, settings = context.scene, context.scene.sparselens
        frames = [scene.frame_current]
        if settings.animation:
            frames = range(scene.frame_start, scene.frame_end + 1,
                           scene.frame_step)
        try:
            views = views_of_lens(settings.views, 0)
            render_frames(scene, frames, bpy.path.abspath(settings.folder),
                          lambda frame: views, eyes_of(scene),
                          several=settings.animation,
                          say=lambda text: self.report({"WARNING"}, text),
                          overscan=(AUTO if settings.overscan_auto
                                    else settings.overscan),
                          multilayer=settings.multilayer,
                          supersample=settings.supersample)
        except (ValueError, OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class SPARSELENS_PT_panel(bpy.types.Panel):
    bl_label = "sparselens"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.camera is not None

    def draw(self, context):
        self.layout.use_property_split = True
        for name in SPARSELENS_Settings.__annotations__:
            self.layout.prop(context.scene.sparselens, name)
        self.layout.operator("sparselens.render_views")


CLASSES = (SPARSELENS_Settings, SPARSELENS_OT_render_views,
           SPARSELENS_PT_panel)


def register():
    for made in CLASSES:
        bpy.utils.register_class(made)
    bpy.types.Scene.sparselens = bpy.props.PointerProperty(
        type=SPARSELENS_Settings)


def unregister():
    del bpy.types.Scene.sparselens
    for made in reversed(CLASSES):
        bpy.utils.unregister_class(made)
