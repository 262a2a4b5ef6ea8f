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

import json
import os
import tempfile

import numpy as np

from . import _relume
from ._relume import (Asset, Camera, Error, Light, Mesh, NoDeviceError, Scene, UsageError, brdf_values, device,
                      devices, materials, use_device)

__all__ = ["Asset", "Camera", "Error", "Image", "Light", "Mesh", "NoDeviceError", "Renderer", "Scene", "UsageError",
           "SampledReference", "advise", "bake", "brdf", "brdf_values", "compare", "device", "devices", "errors",
           "load_image", "materials", "plan", "radiance_errors", "reference", "use_device"]


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
            try:
                self.save(path)
            except Error:  # pixels that are not finite
                return None
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
    if up not in ("y", "z"):
        raise UsageError(f'up: expected "y" or "z", found {up!r}')
    if material is not None and not isinstance(material, str):
        material = _set_of(list(material))
    if isinstance(mesh, Mesh):
        if up != "y":
            raise UsageError('up: expected "y" for a Mesh: turn its positions')
        self._add_mesh(mesh, material, name, brush_rotation)
    else:
        self._add_file(os.fspath(mesh), material, name, up == "z", brush_rotation)
    return self


def _set_of(materials):
    """The set of several materials as JSON; a single one as it is."""
    if not materials or not all(isinstance(text, str) for text in materials):
        raise UsageError(f"material: expected a material or a list of them, found {materials!r:.100}")
    try:
        parsed = [json.loads(text) if text.lstrip().startswith("{") else text for text in materials]
    except (ValueError, RecursionError) as failure:
        raise UsageError(f"material: is not valid JSON: {failure}") from None
    return materials[0] if len(parsed) == 1 else json.dumps({"set": parsed})


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
    options, as those of `relume bake`: preset, terms, factorization, layout, error, budget, coefficients, bounces,
    map_size, face_size, visibility_size, visibility, transport_samples, occluder_triangles, refine, keep_visibility.
    """
    if not isinstance(scene, Scene):
        scene = Scene().add(scene)
    return _relume._bake(scene, None if output is None else os.fspath(output), progress, **options)


def plan(scene, **options):
    """The Asset that bake() would make, before its first vertex: meshes and factored materials without transport.

    That is all that reference() and SampledReference need.
    """
    if not isinstance(scene, Scene):
        scene = Scene().add(scene)
    return _relume._plan(scene, **options)


class Renderer:
    """Draws an asset into images of a size (width, height)."""

    def __init__(self, asset, size=(960, 720), samples=4, residual=True):
        self._renderer = _relume.Renderer(asset, tuple(size), samples, residual)

    def bind(self, materials):
        """Binds materials to all parts that have them: a name, or weights by name."""
        self._renderer.bind({materials: 1.0} if isinstance(materials, str) else dict(materials))

    def select_light(self, threshold=None, coefficients=None):
        """Which of the light's coefficients are kept: those above a threshold, or so many. Neither: the default."""
        self._renderer.select_light(threshold, coefficients)

    def select_terms(self, terms=None):
        """Sums the first of the K terms only. None: all."""
        self._renderer.select_terms(terms)

    def render(self, light, camera=None, background=False):
        """An Image under a Light. camera None: the default view. background: the light behind the object."""
        return Image(self._renderer.render(light, camera, background))

    def relight(self, light):
        """The tuples of every part under a Light: arrays (vertices, K, 3)."""
        return self._renderer.relight(light)


def reference(asset, light, camera=None, size=(960, 720), samples=4, brdf="exact", rays=4, terms=None, progress=None):
    """The image that render() should give, ray-traced.

    brdf: exact, factored (the K terms, or the first of them: terms) or residual. rays: through each texel of the
    light, 1, 4, 16 or 64.
    """
    return Image(_relume._reference(asset, light, camera, tuple(size), samples, brdf, rays, terms, progress))


class SampledReference:
    """The exact image by random rays, which gets better with every pass: the light in 6 x face_size^2 texels."""

    def __init__(self, asset, light, camera=None, size=(960, 720), samples=1, face_size=256):
        self._reference = _relume.SampledReference(asset, light, camera, tuple(size), samples, face_size)

    def add_passes(self, count, progress=None):
        """Sends `count` more rays through every pixel."""
        self._reference.add_passes(count, progress)

    @property
    def passes(self):
        """Rays of a pixel so far."""
        return self._reference.passes

    def mean(self):
        """The Image so far."""
        return Image(self._reference.mean())

    def halves(self):
        """Two Images, of the even and of the odd passes, with noise that is independent; after two passes."""
        even, odd = self._reference.halves()
        return Image(even), Image(odd)


def errors(asset, light, camera=None, size=(120, 90), residual=True, passes=512, bounces=None, images=False,
           progress=None):
    """An image's error taken apart, as `relume errors --json` does. Minutes for larger images.

    light: a Light; or a list of them that share all rays, and then there is a result of each. passes: at most so many
    of the reference that the image is held against, 0 for none. bounces: reflections between surfaces that the exact
    image has, at least the bake's; None: as many. images: adds "images" by name, (height, width, 4):
    drawn, reference and harmonics, linear; total and each source as heat, display values.
    """
    lights = [light] if isinstance(light, Light) else list(light)
    results = _relume._errors(asset, lights, camera, tuple(size), residual, passes, bounces, images, progress)
    return results[0] if isinstance(light, Light) else results


def advise(scene, light, error, points=600, as_is=False, progress=None):
    """The least that a bake must be for images of an error, as `relume advise --json`; takes minutes."""
    if not isinstance(scene, Scene):
        scene = Scene().add(scene)
    return _relume._advise(scene, light, error, points, as_is, progress)


def brdf(material, terms=8, factorization="environment", map_size=48, mapping=None, texels=None):
    """A material's factors: light_maps and view_maps (K, S, S, 3), mapping, and after each term the errors frobenius,
    rms_absolute, rms_relative and expected (docs/factorization.md).

    A list of materials shares its light maps, and gives a list. mapping: orthographic, polar-sine or equal-area;
    texels: centers or means; None: what the factorization takes.
    """
    materials = [material] if isinstance(material, str) else list(material)
    factors = _relume._brdf(materials, terms, factorization, map_size, mapping, texels)
    return factors[0] if isinstance(material, str) else factors


def radiance_errors(material, factors, lights, orientations=60, uniform=False):
    """The relative RMS error of the radiance that unshadowed points reflect, after each term.

    factors: what brdf() returned, in a list. Returns a list of each light, of each of the factors, of K numbers.
    orientations: of the surface in the light, 40 views of each, as the pixels of a convex object have them or, with
    uniform, uniformly over the hemisphere.
    """
    return _relume._radiance_errors(material, list(factors), list(lights), orientations, uniform)
