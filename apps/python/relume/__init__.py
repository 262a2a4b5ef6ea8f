"""Relight glossy objects in real time, with all-frequency shadows.

A bake is made once from meshes and materials; then any distant light draws it in milliseconds:

    import relume
    scene = relume.Scene()
    scene.add("bunny.obj", material="gold")
    scene.add_ground()
    asset = relume.bake(scene, "bunny.relume")
    image = relume.Renderer(asset, size=(960, 540)).render(relume.Light.environment("interior.exr"))
    image.save("bunny.png")

Images are float32 arrays (height, width, 4), rows from the top: linear radiance, premultiplied by coverage, which is
alpha. Angles are degrees. Errors are relume.Error, with the words of the command line.
"""

import os
import tempfile

import numpy as np

from . import _relume
from ._relume import (Asset, Camera, Error, Light, Mesh, NoDeviceError, Scene, UsageError, devices, materials,
                      use_device)

__all__ = ["Asset", "Camera", "Error", "Image", "Light", "Mesh", "NoDeviceError", "Renderer", "Scene", "UsageError",
           "advise", "bake", "brdf", "compare", "devices", "errors", "load_image", "materials", "reference",
           "use_device"]


class Image(np.ndarray):
    """A linear image, float32 (height, width, 4), that notebooks show."""

    def __new__(cls, pixels):
        return np.asarray(pixels, dtype=np.float32).view(cls)

    def save(self, path, exposure=None, tone="agx"):
        """Writes a linear .exr, or a .png by a tone curve (none, aces, agx) at an exposure in stops.

        Without an exposure it is what the object asks for. Returns it.
        """
        return _relume._save(os.fspath(path), self, exposure, tone)

    def _repr_png_(self):
        if self.ndim != 3 or self.shape[2] not in (3, 4):
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "image.png")
            self.save(path)
            with open(path, "rb") as file:
                return file.read()


def load_image(path):
    """Reads a .exr or .hdr file as an Image."""
    return Image(_relume.load_image(os.fspath(path)))


def compare(image, reference):
    """How far an image is from a reference: relative_rmse, psnr (dB), max_difference, flip."""
    return _relume.compare(image, reference)


def _add(self, mesh, material=None, name=None, up="y", brush_rotation=0.0):
    """Adds a mesh: a path (.obj, .ply, .gltf, .glb), a built-in name (knot, sphere, torus, plane) or a Mesh.

    material: a preset, a model, JSON, or a list of these that share the bake. None: a glTF file's own, else gold.
    """
    if isinstance(material, (list, tuple)):
        import json
        parsed = [json.loads(text) if text.lstrip().startswith("{") else text for text in material]
        material = material[0] if len(parsed) == 1 else json.dumps({"set": parsed})
    if isinstance(mesh, Mesh):
        self._add_mesh(mesh, material, name, brush_rotation)
    else:
        self._add_file(os.fspath(mesh), material, up == "z", brush_rotation)
    return self


Scene.add = _add


def _environment(source):
    """Light of an environment: a .exr or .hdr file, or a latlong array (h, 2h, 3) of radiance, +Y up."""
    if isinstance(source, np.ndarray):
        return Light._environment_array(source)
    return Light._environment_file(os.fspath(source))


Light.environment = staticmethod(_environment)


def _orbit(asset, azimuth, elevation, distance=1.0, fov=35.0, aspect=4 / 3):
    """A camera about an asset: angles in degrees, distance 1 just fits it."""
    return _relume._orbit(asset, azimuth, elevation, distance, fov, aspect)


Camera.orbit = staticmethod(_orbit)


def bake(scene, output=None, *, progress=None, **options):
    """Bakes a Scene, or a mesh as Scene.add() takes it, and returns the Asset.

    output: a .relume file to write; a bake that was stopped goes on from its checkpoint. None: in memory.
    progress: called with the share of work done, 0 to 1, now and then. Ctrl-C stops.
    options, as those of `relume bake`: preset, terms, factorization, layout, error, budget, coefficients, map_size,
    face_size, visibility_size, visibility, transport_samples, occluder_triangles, refine, keep_visibility.
    """
    if not isinstance(scene, Scene):
        scene = Scene().add(scene)
    return _relume._bake(scene, None if output is None else os.fspath(output), progress, **options)


class Renderer:
    """Draws an asset into images of a size (width, height)."""

    def __init__(self, asset, size=(960, 720), samples=4, residual=True):
        self._renderer = _relume.Renderer(asset, tuple(size), samples, residual)

    def wear(self, materials):
        """Dresses all parts that have these materials: a name, or weights by name."""
        self._renderer.wear({materials: 1.0} if isinstance(materials, str) else dict(materials))

    def select_light(self, threshold=None, coefficients=None):
        """Which of the light's coefficients are kept: those above a threshold, or so many. Neither: the default."""
        self._renderer.select_light(threshold, coefficients)

    def render(self, light, camera=None, background=False):
        """An Image under a Light. camera None: the default view. background: the light behind the object."""
        return Image(self._renderer.render(light, camera, background))

    def relight(self, light):
        """The tuples of every part under a Light: arrays (vertices, K, 3)."""
        return self._renderer.relight(light)


def reference(asset, light, camera=None, size=(960, 720), samples=4, brdf="exact", progress=None):
    """The image that render() should give, ray-traced. brdf: exact, factored (the K terms) or residual."""
    return Image(_relume._reference(asset, light, camera, tuple(size), samples, brdf, progress))


def errors(asset, light, camera=None, size=(120, 90), residual=True, progress=None):
    """An image's error taken apart, as `relume errors --json` does. Minutes for larger images."""
    return _relume._errors(asset, light, camera, tuple(size), residual, progress)


def advise(scene, light, error, points=600, as_is=False, progress=None):
    """The least that a bake must be for images of an error, as `relume advise --json`; takes minutes."""
    if not isinstance(scene, Scene):
        scene = Scene().add(scene)
    return _relume._advise(scene, light, error, points, as_is, progress)


def brdf(material, terms=8, factorization="environment", map_size=48):
    """A material's factors: light_maps and view_maps (K, S, S, 3), mapping, and after each term the errors frobenius
    and expected (docs/factorization.md)."""
    return _relume._brdf(material, terms, factorization, map_size)
