"""Renders the views of a layer of USD with the scene of a .blend file: imports its cameras, and renders each.

    blender -b FILE.blend -P usd_views.py -- VIEWS.usda OUT_FOLDER SAMPLES
"""

import os
import sys

import bpy

layer, folder, samples = sys.argv[sys.argv.index("--") + 1:]
before = set(bpy.data.objects)
bpy.ops.wm.usd_import(filepath=layer, import_cameras=True, set_frame_range=False)
cameras = sorted((o for o in set(bpy.data.objects) - before if o.type == "CAMERA"), key=lambda o: o.name)
assert [o.name for o in cameras] == ["center", "view_0", "view_1", "view_2", "view_3"], [o.name for o in cameras]
scene = bpy.context.scene
scene.cycles.samples = int(samples)
settings = scene.render.image_settings
settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
bpy.context.view_layer.use_pass_z = True
for seed, camera in enumerate(cameras):
    print("CAMERA", camera.name, tuple(camera.matrix_world.translation), camera.data.lens, camera.data.sensor_width,
          camera.data.angle_x, camera.data.clip_start, camera.data.dof.use_dof, camera.data.dof.aperture_fstop)
    scene.camera = camera
    camera.data.dof.use_dof = False  # the importer has no other way to say it
    scene.cycles.seed = seed
    scene.render.filepath = os.path.join(folder, camera.name + ".exr")
    bpy.ops.render.render(write_still=True)
