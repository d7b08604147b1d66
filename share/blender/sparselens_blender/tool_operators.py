"""The operators of the preferences, which find and install the tools."""

import bpy

from . import tools, unpack
from .render_job import ERRORS, chosen_folder
from .words import report


class SPARSELENS_OT_find_tools(bpy.types.Operator):
    """Look for sparselens' tools, and say which version is found where"""

    bl_idname = "sparselens.find_tools"
    bl_label = "Test"

    def execute(self, context):
        try:
            folder, where = tools.find(chosen_folder())
            text = "%s, %s: %s" % (tools.version(folder), where, folder)
        except ERRORS as error:
            report(self, "ERROR", error)
            return {"CANCELLED"}
        self.report({"INFO"}, text)
        return {"FINISHED"}


class SPARSELENS_OT_install_tools(bpy.types.Operator):
    bl_idname = "sparselens.install_tools"
    bl_label = "Install Tools"
    bl_description = ("Unpack the archive of sparselens' tools for this "
                      "add-on: " + unpack.ARCHIVE)

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.tar.xz;*.zip",
                                          options={"HIDDEN"})

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        try:
            folder = unpack.unpack(bpy.path.abspath(self.filepath),
                                   tools.folder_of_archives(), tools.version)
            text = "%s, installed: %s" % (tools.version(folder), folder)
        except ERRORS as error:
            report(self, "ERROR", error)
            return {"CANCELLED"}
        self.report({"INFO"}, text)
        return {"FINISHED"}
