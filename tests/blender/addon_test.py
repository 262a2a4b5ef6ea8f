"""blender -b --python addon_test.py: the default cube in a Principled metal is baked, and drawn as that metal.

RELUME_PROGRAM is the program; the add-on is beside this file's project.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import traceback

import bpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["RELUME_PROGRAM"]


def test():
    sys.path.insert(0, str(ROOT / "apps" / "blender"))
    import relume_addon
    os.environ["PATH"] = os.path.dirname(PROGRAM) + os.pathsep + os.environ["PATH"]
    relume_addon.register()

    bpy.ops.wm.read_factory_settings()
    relume_addon.unregister()
    relume_addon.register()
    cube = bpy.data.objects["Cube"]
    principled = cube.data.materials[0].node_tree.nodes["Principled BSDF"]
    principled.inputs["Base Color"].default_value = (1, 0.1, 0.05, 1)
    principled.inputs["Metallic"].default_value = 1
    principled.inputs["Roughness"].default_value = 0.3
    for other in bpy.data.objects:
        other.select_set(other == cube)

    with tempfile.TemporaryDirectory() as folder:
        output, image = os.path.join(folder, "cube.relume"), os.path.join(folder, "cube.exr")
        settings = bpy.context.scene.relume
        settings.output, settings.ground, settings.terms = output, False, 2
        assert bpy.ops.relume.bake() == {"FINISHED"}, settings.status
        info = json.loads(subprocess.check_output([PROGRAM, "info", output, "--json"]))
        material = info["parts"][0]["sets"][0]["materials"][0]["brdf"]
        assert material["model"] == "gltf" and material["metallic"] == 1, material
        assert abs(material["roughness"] - 0.3) < 1e-6, material
        subprocess.check_call([PROGRAM, "render", output, "--size", "64x48", "-o", image])
        picture = bpy.data.images.load(image)
        pixels = list(picture.pixels)
        red, green, covered = sum(pixels[0::4]), sum(pixels[1::4]), sum(pixels[3::4])
        assert covered > 300, covered
        assert red > 3 * green > 0, (red, green)

        # What cannot be baked is told.
        cube.select_set(False)
        try:
            bpy.ops.relume.bake()
            raise AssertionError("a bake of nothing")
        except RuntimeError as failure:
            assert "select the objects" in str(failure), failure


try:
    test()
except BaseException:
    traceback.print_exc()
    sys.exit(1)
print("addon_test: passed")
