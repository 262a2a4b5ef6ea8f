"""Bakes the selection with Relume and opens the viewer on it: Blender 3.4 and later.

Install this file under Preferences > Add-ons. The panel is in the 3D view's sidebar (N), tab Relume.
"""

bl_info = {
    "name": "Relume",
    "author": "The Relume authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > Relume",
    "description": "Bake selected objects for relighting in real time",
    "category": "Render",
}

import json
import os
import shutil
import subprocess

import threading

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty


class RelumePreferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: StringProperty(name="relume", subtype="FILE_PATH", description="The program; empty: that on the path")
    viewer: StringProperty(name="relume-viewer", subtype="FILE_PATH",
                           description="The viewer; empty: that on the path")

    def draw(self, context):
        self.layout.prop(self, "program")
        self.layout.prop(self, "viewer")


def program_path(name):
    """The path of relume or relume-viewer, or None."""
    addon = bpy.context.preferences.addons.get(__name__)
    chosen = getattr(addon.preferences, {"relume": "program", "relume-viewer": "viewer"}[name], "") if addon else ""
    return bpy.path.abspath(chosen) if chosen else shutil.which(name)


class RelumeSettings(bpy.types.PropertyGroup):
    output: StringProperty(name="Bake", subtype="FILE_PATH", default="//bake.relume",
                           description="The .relume file to write")
    ground: BoolProperty(name="Ground", default=True, description="Put a diffuse ground under the objects")
    opens_viewer: BoolProperty(name="Open viewer", default=True, description="Look at it when it is baked")
    terms: IntProperty(name="Terms", default=0, min=0, max=32,
                       description="Terms of each material's BRDF; 0: as Relume chooses")
    progress: FloatProperty(name="Progress", subtype="PERCENTAGE", min=0, max=100)
    status: StringProperty()


def export_selection(path):
    """Writes the selected objects with their materials as .glb, modifiers applied."""
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", use_selection=True, export_apply=True,
                              export_yup=True, export_animations=False, export_cameras=False, export_lights=False)


def bake_command(mesh, settings, output):
    command = [program_path("relume"), "bake", mesh, "--json", "-q", "-o", output]
    if settings.ground:
        command.append("--ground")
    if settings.terms > 0:
        command += ["--terms", str(settings.terms)]
    return command


class Bake:
    """A bake beside Blender. Its fields are written by a thread and read by a timer."""

    def __init__(self, command):
        self.share, self.error = 0.0, ""
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.threads = [threading.Thread(target=self._read_events), threading.Thread(target=self._read_errors)]
        for thread in self.threads:
            thread.start()

    def _read_events(self):
        for line in self.process.stdout:
            event = json.loads(line)
            if "fraction" in event:
                self.share = max(self.share, event["fraction"])

    def _read_errors(self):
        for line in self.process.stderr:
            if line.startswith("error:"):
                self.error = line[len("error:"):].strip()

    def stop(self):
        """Keeps what is baked: the same bake goes on from there."""
        self.process.terminate()

    def result(self):
        """None while it runs; then whether it is done."""
        if self.process.poll() is None:
            return None
        for thread in self.threads:
            thread.join()
        return self.process.returncode == 0


def prepare(context):
    """Exports the selection and returns the command and the bake's path. Raises RuntimeError with what to do."""
    if not program_path("relume"):
        raise RuntimeError("relume is not on the path; name it in the add-on's preferences")
    if not any(selected.type == "MESH" for selected in context.selected_objects):
        raise RuntimeError("select the objects to bake: at least one mesh")
    settings = context.scene.relume
    output = bpy.path.abspath(settings.output)
    if not os.path.isabs(output):
        raise RuntimeError("save the file first, or give the bake an absolute path")
    mesh = os.path.splitext(output)[0] + ".glb"
    export_selection(mesh)
    return bake_command(mesh, settings, output), output


class RELUME_OT_bake(bpy.types.Operator):
    bl_idname = "relume.bake"
    bl_label = "Bake"
    bl_description = "Export the selected objects and bake them in the background; Esc stops"

    def execute(self, context):
        """At once, for scripts."""
        try:
            command, output = prepare(context)
        except RuntimeError as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        bake = Bake(command)
        bake.process.wait()
        return self._finish(context, bake, output)

    def invoke(self, context, event):
        try:
            command, self._output = prepare(context)
        except RuntimeError as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        self._bake = Bake(command)
        self._timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        settings = context.scene.relume
        if event.type == "ESC":
            self._bake.stop()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        settings.progress = 100 * self._bake.share
        settings.status = f"Baking: {settings.progress:.0f} %"
        for area in context.screen.areas:
            area.tag_redraw()
        if self._bake.result() is None:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        return self._finish(context, self._bake, self._output)

    def _finish(self, context, bake, output):
        settings = context.scene.relume
        if not bake.result():
            settings.status = "Stopped; Bake goes on from there" if not bake.error else bake.error
            if bake.error:
                self.report({"ERROR"}, bake.error)
            return {"CANCELLED"}
        settings.progress, settings.status = 100, f"Baked {os.path.basename(output)}"
        if settings.opens_viewer and not bpy.app.background:
            open_viewer(context, output)
        return {"FINISHED"}


def environment_of(context):
    """The path of the world's environment texture, or None."""
    world = context.scene.world
    if not world or not world.use_nodes:
        return None
    for node in world.node_tree.nodes:
        if node.type == "TEX_ENVIRONMENT" and node.image and node.image.source == "FILE":
            path = bpy.path.abspath(node.image.filepath)
            if os.path.splitext(path)[1] in (".exr", ".hdr") and os.path.exists(path):
                return path
    return None


def open_viewer(context, output):
    viewer = program_path("relume-viewer")
    if not viewer:
        raise RuntimeError("relume-viewer is not on the path; name it in the add-on's preferences")
    environment = environment_of(context)
    subprocess.Popen([viewer, output] + ([environment] if environment else []))


class RELUME_OT_view(bpy.types.Operator):
    bl_idname = "relume.view"
    bl_label = "Open Viewer"
    bl_description = "Look at the bake in any light; begins with the world's environment"

    @classmethod
    def poll(cls, context):
        return os.path.exists(bpy.path.abspath(context.scene.relume.output))

    def execute(self, context):
        try:
            open_viewer(context, bpy.path.abspath(context.scene.relume.output))
        except RuntimeError as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        return {"FINISHED"}


class RELUME_PT_panel(bpy.types.Panel):
    bl_idname = "RELUME_PT_panel"
    bl_label = "Relume"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Relume"

    def draw(self, context):
        settings = context.scene.relume
        column = self.layout.column()
        for name in ("output", "ground", "terms", "opens_viewer"):
            column.prop(settings, name)
        column.operator(RELUME_OT_bake.bl_idname)
        column.operator(RELUME_OT_view.bl_idname)
        if settings.status:
            column.label(text=settings.status)


CLASSES = (RelumePreferences, RelumeSettings, RELUME_OT_bake, RELUME_OT_view, RELUME_PT_panel)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.relume = bpy.props.PointerProperty(type=RelumeSettings)


def unregister():
    del bpy.types.Scene.relume
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)


if __name__ == "__main__":
    register()
