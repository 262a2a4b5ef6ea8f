"""The Python module, held against the command line: what it returns is what `relume` prints and writes.

Run by ctest with RELUME_PROGRAM; PYTHONPATH names the module.
"""

import ast
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import relume

PROGRAM = os.environ["RELUME_PROGRAM"]
SIZE = (160, 120)
OPTIONS = dict(terms=2, visibility_size=64, refine="off")
ARGUMENTS = ["-K", "2", "--visibility-size", "64", "--refine", "off"]


def run(*arguments):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if result.returncode != 0:
        raise AssertionError(f"relume {arguments}: {result.stderr}")
    return result.stdout


def run_json(*arguments):
    return json.loads(run(*arguments, "--json"))


class ModuleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = os.path.join(cls.folder.name, "module.relume")
        # A ring of few vertices, in a file that both can read.
        around, along = np.meshgrid(np.arange(24) / 24, np.arange(12) / 12, indexing="ij")
        radius = 1 + 0.4 * np.cos(2 * np.pi * along)
        places = np.stack([radius * np.cos(2 * np.pi * around), 0.4 * np.sin(2 * np.pi * along),
                           radius * np.sin(2 * np.pi * around)], axis=-1).reshape(-1, 3)
        cls.mesh = os.path.join(cls.folder.name, "ring.obj")
        with open(cls.mesh, "w") as file:
            file.writelines("v %.6f %.6f %.6f\n" % tuple(place) for place in places)
            for i in range(24):
                for j in range(12):
                    a, b = 12 * i + j, 12 * i + (j + 1) % 12
                    c, d = (a + 12) % 288, (b + 12) % 288
                    file.write(f"f {a + 1} {b + 1} {d + 1} {c + 1}\n")
        scene = relume.Scene().add(cls.mesh, material="gold")
        scene.add_ground(tessellation=10)
        cls.shares = []
        cls.asset = relume.bake(scene, cls.path, progress=cls.shares.append, **OPTIONS)
        cls.light = relume.Light.sky()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def file(self, name):
        return os.path.join(self.folder.name, name)

    def test_bake_gives_the_bytes_of_the_command_line(self):
        other = self.file("cli.relume")
        run("bake", self.mesh, "--ground", "--ground-tessellation", 10, "-m", "gold", *ARGUMENTS, "-q", "-o", other)
        with open(self.path, "rb") as a, open(other, "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.assertEqual(self.shares[-1], 1)
        self.assertEqual(self.shares, sorted(self.shares))

    def test_bake_in_memory_is_the_same(self):
        scene = relume.Scene().add(self.mesh, material="gold")
        scene.add_ground(tessellation=10)
        relume.bake(scene, **OPTIONS).save(self.file("memory.relume"))
        with open(self.path, "rb") as a, open(self.file("memory.relume"), "rb") as b:
            self.assertEqual(a.read(), b.read())

    def test_render_is_that_of_the_command_line(self):
        image = relume.Renderer(self.asset, SIZE).render(self.light)
        self.assertEqual(image.shape, (SIZE[1], SIZE[0], 4))
        self.assertEqual(image.dtype, np.float32)
        run("render", self.path, "--size", "160x120", "-o", self.file("cli.exr"))
        np.testing.assert_array_equal(image, relume.load_image(self.file("cli.exr")))
        # With the light behind it, toned.
        shown = relume.Renderer(self.asset, SIZE).render(self.light, background=True)
        shown.save(self.file("module.png"), exposure=0)
        run("render", self.path, "--size", "160x120", "--exposure", 0, "--background", "environment", "-o",
            self.file("cli.png"))
        with open(self.file("module.png"), "rb") as a, open(self.file("cli.png"), "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.assertTrue(image._repr_png_().startswith(b"\x89PNG"))

    def test_lights_cameras_and_residual(self):
        renderer = relume.Renderer(self.asset, SIZE, residual=False)
        image = renderer.render(relume.Light.lamp(40, 50, 3, [1 / np.sin(np.radians(3)) ** 2] * 3),
                                relume.Camera.orbit(self.asset, 30, 15, 1, aspect=SIZE[0] / SIZE[1]))
        run("render", self.path, "--size", "160x120", "--sphere-light", "40,50,3", "--orbit", "30,15,1", "--residual",
            "off", "-o", self.file("lamp.exr"))
        np.testing.assert_allclose(image, relume.load_image(self.file("lamp.exr")), rtol=1e-5, atol=1e-6)
        # A sum of lights is lit by both: relighting is linear, but for the coefficients that are kept.
        lamp, sky = relume.Light.distant(0, 60, [1, 1, 1]), relume.Light.sky()
        renderer.select_light(coefficients=6 * 64 * 64)
        parts = [renderer.render(light) for light in (lamp, sky, lamp + sky)]
        # K terms may sum to less than 0, which is drawn as 0.
        np.testing.assert_allclose((parts[0] + parts[1])[..., :3], parts[2][..., :3], atol=0.02 * parts[2].max())
        np.testing.assert_allclose(renderer.render(2 * sky)[..., :3], 2 * parts[1][..., :3],
                                   atol=1e-3 * parts[1].max())

    def test_environment_arrays_are_files(self):
        radiance = np.random.default_rng(1).random((64, 128, 3), dtype=np.float32)
        relume.Image(np.dstack([radiance, np.ones((64, 128), np.float32)])).save(self.file("map.exr"))
        renderer = relume.Renderer(self.asset, SIZE)
        np.testing.assert_array_equal(renderer.render(relume.Light.environment(radiance)),
                                      renderer.render(relume.Light.environment(self.file("map.exr"))))
        run("render", self.path, "--size", "160x120", "-e", self.file("map.exr"), "-o", self.file("mapped.exr"))
        np.testing.assert_array_equal(renderer.render(relume.Light.environment(radiance)),
                                      relume.load_image(self.file("mapped.exr")))

    def test_tuples_have_their_shape_and_are_linear(self):
        renderer = relume.Renderer(self.asset, SIZE)
        tuples = renderer.relight(self.light)
        self.assertEqual(len(tuples), len(self.asset.parts))
        self.assertEqual(tuples[0].shape[1:], (2, 3))
        self.assertEqual(sum(part.shape[0] for part in tuples), self.asset.vertices)
        for once, twice in zip(tuples, renderer.relight(2 * self.light)):
            np.testing.assert_allclose(2 * once, twice, rtol=1e-6, atol=1e-7)

    def test_reference_is_that_of_the_command_line(self):
        image = relume.reference(self.asset, self.light, size=(24, 18))
        run("reference", self.path, "--size", "24x18", "-o", self.file("truth.exr"))
        np.testing.assert_array_equal(image, relume.load_image(self.file("truth.exr")))
        drawn = relume.Renderer(self.asset, (24, 18)).render(self.light)
        drawn.save(self.file("drawn.exr"))
        ours = relume.compare(drawn, image)
        theirs = run_json("compare", self.file("drawn.exr"), self.file("truth.exr"))
        self.assertAlmostEqual(ours["relative_rmse"], theirs["relative_rmse"], places=9)
        self.assertAlmostEqual(ours["flip"], theirs["flip"], places=9)

    def test_references_take_rays_terms_and_plans(self):
        factored = [relume.reference(self.asset, self.light, size=(24, 18), samples=1, rays=1, brdf="factored",
                                     terms=terms) for terms in (1, 2, None)]
        run("reference", self.path, "--size", "24x18", "--samples", 1, "--rays", 1, "--brdf", "factored", "-o",
            self.file("factored.exr"))
        np.testing.assert_array_equal(factored[2], relume.load_image(self.file("factored.exr")))
        np.testing.assert_array_equal(factored[1], factored[2])
        self.assertGreater(np.abs(factored[0] - factored[1]).max(), 0)
        # A plan has all that references need.
        scene = relume.Scene().add(self.mesh, material="gold")
        scene.add_ground(tessellation=10)
        np.testing.assert_array_equal(
            relume.reference(relume.plan(scene, **OPTIONS), self.light, size=(24, 18), samples=1, rays=1,
                             brdf="factored"), factored[2])
        for wrong in (dict(rays=3), dict(terms=1)):
            with self.assertRaises(relume.UsageError):
                relume.reference(self.asset, self.light, size=(8, 6), **wrong)

    def test_a_material_that_cannot_be_bound_changes_nothing(self):
        scene = relume.Scene().add(self.mesh, material='{"separate": ["gold", "clay"]}')
        renderer = relume.Renderer(relume.bake(scene, **OPTIONS), SIZE)
        renderer.bind("clay")
        renderer.render(2 * self.light)
        with self.assertRaises(relume.UsageError):
            renderer.bind({"gold": 1, "clay": 1})
        image = renderer.render(self.light)
        renderer.bind("clay")
        np.testing.assert_array_equal(image, renderer.render(self.light))

    def test_drawn_terms_are_those_of_the_command_line(self):
        renderer = relume.Renderer(self.asset, SIZE)
        renderer.select_terms(1)
        few = renderer.render(self.light)
        run("render", self.path, "--size", "160x120", "--terms", 1, "-o", self.file("terms.exr"))
        np.testing.assert_array_equal(few, relume.load_image(self.file("terms.exr")))
        renderer.select_terms()
        self.assertGreater(np.abs(renderer.render(self.light) - few).max(), 0)

    def test_sampled_references_converge(self):
        size = (40, 30)
        reference = relume.SampledReference(self.asset, self.light, size=size, face_size=64)
        shares = []
        for count in (16, 240):
            reference.add_passes(count, progress=shares.append)
            even, odd = reference.halves()
            np.testing.assert_allclose((even + odd) / 2, reference.mean(), rtol=1e-4, atol=1e-6)
            exact = relume.reference(self.asset, self.light, size=size, samples=1)
            errors = [relume.compare(image, exact)["relative_rmse"] for image in (even, odd, reference.mean())]
            # Noise that is independent: the mean's is smaller than the halves', by the root of two.
            self.assertLess(errors[2], 0.9 * min(errors[:2]))
        self.assertEqual(reference.passes, 256)
        self.assertEqual(shares[-1], 1)
        self.assertLess(errors[2], 0.05)

    def test_coefficients_are_those_that_light_is_weighed_by(self):
        """Light that is even all around has one coefficient a face, the first: its radiance times 64."""
        rows = self.asset.coefficients(0, [0, 1, 540, 541])  # of vertices 0 and 270, of 2 terms each
        self.assertEqual(rows.shape, (4, 6 * 64 * 64, 3))
        even = relume.Light.environment(np.ones((32, 64, 3), np.float32))
        tuples = relume.Renderer(self.asset, SIZE).relight(even)[0]
        np.testing.assert_allclose(64 * rows[:, ::64 * 64].sum(axis=1), tuples[[0, 270]].reshape(4, 3), rtol=1e-3,
                                   atol=1e-4)
        with self.assertRaises(IndexError):
            self.asset.coefficients(0, [2 * len(self.asset.mesh(0).positions)])

    def test_meshes_are_simplified(self):
        mesh = self.asset.mesh(0)
        few = mesh.simplified(200)
        self.assertLessEqual(len(few.triangles), 200)
        self.assertGreater(len(few.triangles), 100)
        np.testing.assert_allclose(np.linalg.norm(few.normals, axis=1), 1, rtol=1e-5)
        np.testing.assert_allclose(few.positions.min(axis=0), mesh.positions.min(axis=0), atol=0.1)
        np.testing.assert_allclose(few.positions.max(axis=0), mesh.positions.max(axis=0), atol=0.1)

    def test_factors_are_measured(self):
        light = relume.Light.environment(np.random.default_rng(1).random((32, 64, 3), dtype=np.float32))
        pixels = np.random.default_rng(1).random((32, 64, 3), dtype=np.float32)
        relume.Image(np.dstack([pixels, np.ones((32, 64), np.float32)])).save(self.file("factors.exr"))
        report = run_json("brdf", "clay", "-K", 3, "--size", 12, "--factorization", "cosine", "-e",
                          self.file("factors.exr"))
        factors = relume.brdf("clay", 3, "cosine", 12)
        np.testing.assert_allclose(factors["rms_absolute"], report["rms_absolute"], rtol=1e-4)
        np.testing.assert_allclose(factors["rms_relative"], report["rms_relative"], rtol=1e-4)
        errors, = relume.radiance_errors("clay", [factors], [light])
        np.testing.assert_allclose(errors[0], report["radiance_error"][self.file("factors.exr")], rtol=1e-4)
        # Members of a set share their light maps, and none is nearer than alone.
        clay, gold = relume.brdf(["clay", "gold"], 3, "cosine", 12)
        np.testing.assert_array_equal(clay["light_maps"], gold["light_maps"])
        together, = relume.radiance_errors("clay", [clay, factors], [light], 5)
        self.assertGreater(together[0][-1], together[1][-1])
        # Terms stand for the BRDF.
        directions = np.array([[0, 0, 1], [0.6, 0, 0.8], [-0.6, 0, 0.8]], np.float32)
        exact = relume.brdf_values("clay", directions, directions[::-1])
        self.assertEqual(exact.shape, (3, 3))
        np.testing.assert_allclose(relume.brdf_values(relume.brdf("clay", 16, "cosine", 24), directions,
                                                      directions[::-1]), exact, rtol=0.2)
        for wrong in (dict(texels="corners"), dict(mapping="square"), dict(terms=0), dict(factorization="qr")):
            with self.assertRaises(relume.UsageError):
                relume.brdf("clay", **wrong)
        with self.assertRaises(ValueError):
            relume.brdf_values({"light_maps": directions}, directions, directions)

    def test_info_materials_and_brdf(self):
        info = self.asset.info()
        self.assertEqual(info["parts"][0]["vertices"], run_json("info", self.path)["parts"][0]["vertices"])
        self.assertEqual(relume.materials(), run_json("materials"))
        factors = relume.brdf("gold", terms=4)
        self.assertEqual(factors["light_maps"].shape, (4, 48, 48, 3))
        report = run_json("brdf", "gold", "-K", "4", "--factorization", "environment")
        np.testing.assert_allclose(factors["expected"], report["expected_radiance_error"], rtol=1e-4)
        self.assertEqual(relume.devices()[0]["name"], run_json("devices")[0]["name"])
        self.assertIn(relume.device(), relume.devices())

    def test_errors_are_those_of_the_command_line(self):
        ours = relume.errors(self.asset, relume.Light.lamp(40, 50, 20, [1, 1, 1]), size=(4, 3))
        light = self.file("lamp.light.json")
        with open(light, "w") as file:
            json.dump({"lamps": [{"azimuth": 40, "elevation": 50, "radius": 20, "radiance": [1, 1, 1]}]}, file)
        theirs = run_json("errors", self.path, "--light", light, "--size", "4x3")
        self.assertEqual(ours, theirs)
        self.assertEqual([part["name"] for part in ours["parts"]], self.asset.parts)
        self.assertEqual(sum(part["points"] for part in ours["parts"]), ours["points"])
        both = relume.errors(self.asset, [relume.Light.lamp(40, 50, 20, [1, 1, 1]), self.light], size=(4, 3),
                             passes=0, images=True)
        self.assertEqual(both[0]["sources"], ours["sources"])
        self.assertEqual(both[1]["measured"], 0)
        self.assertEqual(both[1]["images"]["interpolation"].shape, (3, 4, 4))
        self.assertEqual(len(both[1]["images"]), 4 + len(ours["sources"]))

    def test_advice_is_that_of_the_command_line(self):
        ours = relume.advise(relume.Scene().add(self.mesh, material="white-diffuse"), relume.Light.lamp(40, 50, 20, [1, 1, 1]),
                             error=0.1, points=40, as_is=True)
        light = self.file("advise.light.json")
        with open(light, "w") as file:
            json.dump({"lamps": [{"azimuth": 40, "elevation": 50, "radius": 20, "radiance": [1, 1, 1]}]}, file)
        theirs = run_json("advise", self.mesh, "-m", "white-diffuse", "--light", light, "--error", 0.1, "--points", 40,
                          "--as-is")
        for advice in (ours, theirs):  # seconds are measured
            for layout in ("bases", "rows"):
                if advice["plain"][layout]:
                    del advice["plain"][layout]["seconds"]
        self.assertEqual(ours, theirs)

    def test_meshes_go_in_and_out(self):
        mesh = self.asset.mesh(0)
        again = relume.Mesh(mesh.positions, mesh.triangles, normals=mesh.normals)
        self.assertEqual(again.positions.shape, mesh.positions.shape)
        for triangles in ([[0, 1, 2]], np.array([[0, 1, 2]], np.uint64), np.array([[0.0, 1.0, 2.0]])):
            self.assertEqual(relume.Mesh(np.eye(3), triangles).triangles.tolist(), [[0, 1, 2]])
        self.assertEqual(relume.Scene().add(self.mesh, name="hoop").parts, ["hoop"])
        with self.assertRaises(ValueError):
            relume.Mesh(np.zeros((3, 2)), [[0, 1, 2]])

    def test_renderers_outlive_the_choice_of_a_device_and_python(self):
        renderer = relume.Renderer(self.asset, SIZE)
        before = renderer.render(self.light)
        relume.use_device("")
        np.testing.assert_array_equal(renderer.render(self.light), before)
        # One that is a global when Python ends is no crash.
        script = ("import relume\n"
                  f"renderer = relume.Renderer(relume.Asset.load({self.path!r}), (16, 12))\n"
                  "renderer.render(relume.Light.sky())\n")
        self.assertEqual(subprocess.run([sys.executable, "-c", script]).returncode, 0)

    def test_type_stubs_name_what_the_module_has_once(self):
        stub = pathlib.Path(relume.__file__).with_suffix(".pyi")
        names = [node.name for node in ast.parse(stub.read_text()).body
                 if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_")
                 and not any(isinstance(mark, ast.Name) and mark.id == "overload" for mark in node.decorator_list)]
        self.assertEqual(len(names), len(set(names)))
        for name in names:
            self.assertTrue(hasattr(relume, name), name)

    def test_errors_say_what_the_command_line_says(self):
        with self.assertRaisesRegex(relume.Error, "nowhere.relume"):
            relume.Asset.load("nowhere.relume")
        with self.assertRaisesRegex(relume.UsageError, "golb"):
            relume.Scene().add(self.asset.mesh(0), material="golb")
        with self.assertRaisesRegex(TypeError, "tems"):
            relume.bake("sphere", tems=3)
        with self.assertRaises(relume.UsageError):
            relume.bake("sphere", terms=99)

    def test_arguments_are_not_trusted(self):
        asset, light, nan, inf, size = self.asset, self.light, float("nan"), float("inf"), (16, 12)
        renderer, reference = relume.Renderer(asset, size), relume.SampledReference(asset, light, size=size)
        scene = relume.Scene().add(self.mesh, material="clay")
        plan = relume.plan(scene, **OPTIONS)
        corners = np.eye(3)

        def filled(value, *shape):
            return np.full(shape, value, np.float32)
        for name, wrong in (  # what the message names
                ("size", lambda: relume.Renderer(asset, (0, 4))),
                ("size", lambda: relume.Renderer(asset, (-4, 4))),
                ("asset", lambda: relume.Renderer(None, size)),
                ("plan", lambda: relume.Renderer(plan, size)),
                ("plan", lambda: relume.errors(plan, light, size=(4, 3))),
                ("plan", lambda: plan.coefficients(0, [0])),
                ("samples", lambda: relume.Renderer(asset, size, samples=3)),
                ("weight", lambda: renderer.bind({"gold": nan})),
                ("weight", lambda: renderer.bind({"gold": -1})),
                ("weight", lambda: renderer.bind({})),
                ("terms", lambda: renderer.select_terms(0)),
                ("threshold", lambda: renderer.select_light(threshold=-1)),
                ("coefficients", lambda: renderer.select_light(coefficients=0)),
                ("eye", lambda: relume.Camera([nan, 0, 0], [0, 0, 0])),
                ("eye", lambda: relume.Camera([1, 1, 1], [1, 1, 1])),
                ("target", lambda: relume.Camera([1, 1, 1], [0, inf, 0])),
                ("fov", lambda: relume.Camera([1, 1, 1], [0, 0, 0], fov=nan)),
                ("fov", lambda: relume.Camera([1, 1, 1], [0, 0, 0], fov=180)),
                ("azimuth", lambda: relume.Camera.orbit(asset, nan, 0)),
                ("distance", lambda: relume.Camera.orbit(asset, 0, 0, -1)),
                ("aspect", lambda: relume.Camera.orbit(asset, 0, 0, 1, 35, 0)),
                ("azimuth", lambda: relume.Light.lamp(nan, 0, 3, [1, 1, 1])),
                ("radius", lambda: relume.Light.lamp(0, 0, 1e-30, [1, 1, 1])),
                ("radiance", lambda: relume.Light.lamp(0, 0, 3, [1, nan, 1])),
                ("irradiance", lambda: relume.Light.distant(0, 0, [-1, 0, 0])),
                ("environment", lambda: relume.Light.environment(filled(nan, 4, 8, 3))),
                ("environment", lambda: relume.Light.environment(filled(1e20, 4, 8, 3))),
                ("light", lambda: relume.Light.environment(filled(1e12, 4, 8, 3)) * 1e5),
                ("gain", lambda: light * 1e38),
                ("scaled", lambda: light * nan),
                ("degrees", lambda: light.turned(nan)),
                ("seconds", lambda: relume.Light.load(self.mesh, nan)),
                ("sources", lambda: sum([relume.Light.lamp(0, 9, 3, [1, 1, 1])] * 600, light)),
                ("triangles", lambda: relume.Mesh(corners, [[0, 1, 3]])),
                ("triangles", lambda: relume.Mesh(corners, [[0, 1, -1]])),
                ("triangles", lambda: relume.Mesh(corners, [[0, 1, 2**32 + 2]])),
                ("triangles", lambda: relume.Mesh(corners, [[0, 1, 1.5]])),
                ("mesh", lambda: relume.Mesh(filled(nan, 3, 3), [[0, 1, 2]])),
                ("up", lambda: relume.Scene().add(self.mesh, up="x")),
                ("brush_rotation", lambda: relume.Scene().add(self.mesh, brush_rotation=inf)),
                ("material", lambda: relume.Scene().add(self.mesh, [])),
                ("material", lambda: relume.Scene().add(self.mesh, "")),
                ("material", lambda: relume.Scene().add(self.mesh, ["gold", "{"])),
                ("material", lambda: relume.Scene().add(self.mesh, ["gold", None])),
                ("up", lambda: relume.Scene().add(relume.Mesh(corners, [[0, 1, 2]]), up="z")),
                ("origin", lambda: relume.Scene().add(relume.Mesh(1e-3 * corners + 1e3, [[0, 1, 2]]))),
                ("golb", lambda: scene.add_ground("golb")),
                ("tessellation", lambda: scene.add_ground(tessellation=0)),
                ("extent", lambda: scene.add_ground(extent=nan)),
                ("layout", lambda: relume.bake(scene, layout="rows", error=0.1)),
                ("budget", lambda: relume.bake(scene, budget=100, error=0.1)),
                ("occluder", lambda: relume.bake(scene, occluder_triangles=1)),
                ("parts", lambda: relume.bake(relume.Scene())),
                ("refine", lambda: relume.bake(scene, refine=nan)),
                ("error", lambda: relume.bake(scene, error=nan)),
                ("asset", lambda: relume.reference(None, light)),
                ("terms", lambda: relume.reference(asset, light, size=size, brdf="factored", terms=0)),
                ("asset", lambda: relume.SampledReference(None, light)),
                ("face_size", lambda: relume.SampledReference(asset, light, size=size, face_size=1)),
                ("count", lambda: reference.add_passes(-1)),
                ("mean", reference.mean),
                ("halves", reference.halves),
                ("asset", lambda: relume.errors(None, light)),
                ("light", lambda: relume.errors(asset, [], size=(4, 3))),
                ("passes", lambda: relume.errors(asset, light, size=(4, 3), passes=-1)),
                ("size", lambda: relume.errors(asset, light, size=(1000, 1000))),
                ("points", lambda: relume.advise(scene, light, 0.1, points=0)),
                ("error", lambda: relume.advise(scene, light, nan)),
                ("material", lambda: relume.brdf([])),
                ("incoming", lambda: relume.brdf_values("gold", filled(0, 1, 3), filled(1, 1, 3))),
                ("outgoing", lambda: relume.brdf_values("gold", filled(1, 1, 3), filled(inf, 1, 3))),
                ("image", lambda: relume.Image(filled(nan, 2, 2, 4)).save(self.file("nan.png"))),
                ("exposure", lambda: relume.Image(filled(1, 2, 2, 4)).save(self.file("nan.png"), exposure=nan))):
            with self.subTest(name=name), self.assertRaisesRegex(relume.Error, name):
                wrong()
        self.assertFalse(os.path.exists(self.file("nan.png")))
        patch = relume.Light.environment(filled(1e-3, 4, 8, 3))
        renderer.relight(sum([patch] * 600, patch))  # there may be any number of maps
        for error, wrong in ((TypeError, lambda: relume.bake(scene, terms=2.5)), (IndexError, lambda: asset.mesh(9)),
                             (TypeError, lambda: renderer.render(None))):
            with self.assertRaises(error):
                wrong()

    def test_threads_share_what_they_call(self):
        renderer = relume.Renderer(self.asset, (64, 48))
        reference = relume.SampledReference(self.asset, self.light, size=(16, 12))
        reference.add_passes(2)
        failures = []

        def repeat(call):
            try:
                for _ in range(5):
                    call()
            except Exception as failure:
                failures.append(failure)
        threads = [threading.Thread(target=repeat, args=(call,)) for call in (
            lambda: renderer.render(self.light), lambda: renderer.render(self.light, background=True),
            lambda: renderer.relight(self.light), lambda: renderer.bind("gold"), lambda: renderer.select_terms(1),
            lambda: reference.add_passes(2, lambda share: reference.passes), reference.halves,
            lambda: relume.reference(self.asset, self.light, size=(16, 12), samples=1, rays=1,
                                     progress=lambda share: reference.mean()))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])
        self.assertEqual(reference.passes, 12)

    def test_ctrl_c_and_callbacks_end_a_bake(self):
        threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            relume.bake("knot", terms=8)

        def fail(share):
            raise KeyError("mine")
        with self.assertRaises(KeyError):
            relume.bake("knot", progress=fail)

    def test_a_light_is_found_from_a_picture(self):
        """The example of docs/python.md: relighting is linear, so least squares over patches of light find it."""
        from scipy.optimize import lsq_linear
        rng = np.random.default_rng(7)
        patches, truth = [], np.zeros((32, 64, 3), np.float32)
        for row in range(4):
            for column in range(8):
                patch = np.zeros((32, 64, 3), np.float32)
                patch[8 * row:8 * row + 8, 8 * column:8 * column + 8] = 1
                patches.append(patch)
                truth += patch * rng.random(3).astype(np.float32)
        renderer = relume.Renderer(self.asset, (96, 72), residual=False)
        renderer.select_light(coefficients=6 * 64 * 64)
        target = renderer.render(relume.Light.environment(truth))
        basis = np.stack([renderer.render(relume.Light.environment(patch))[..., :3].reshape(-1, 3)
                          for patch in patches]).astype(np.float64)
        found = np.zeros_like(truth)
        for channel in range(3):
            weights = lsq_linear(basis[:, :, channel].T, target[..., channel].ravel().astype(np.float64),
                                 bounds=(0, np.inf)).x
            found[..., channel] = sum(weight * patch[..., channel] for weight, patch in zip(weights, patches))
        error = relume.compare(renderer.render(relume.Light.environment(found)), target)
        self.assertLessEqual(error["relative_rmse"], 0.01)


if __name__ == "__main__":
    unittest.main()
