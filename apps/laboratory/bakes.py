"""Bakes, made when a step first needs one and deleted with the last; those of one mesh share their visibility."""

import dataclasses
import json
import os
from typing import Any, Mapping, Optional

import relume

from .inputs import Input
from .program import Program
from .store import Path, hash_of, replacing


@dataclasses.dataclass(frozen=True)
class Recipe:
    """A bake: what decides its bytes on a device."""
    title: str
    model: Input
    material: str  # as `relume bake` takes it
    options: Mapping[str, Any]  # of `relume bake`, as relume.bake() names them
    ground: Optional[int] = None  # quads a side, white-diffuse; None: none
    triangles: int = 0  # that the model is simplified to; 0: all

    @property
    def is_published(self) -> bool:
        """Whether it is baked in the paper's way, which knows of no residual."""
        return self.options.get("preset") == "paper"

    def key(self) -> Any:
        return [self._mesh_key(), self.material, dict(self.options)]

    def visibility_key(self) -> Optional[Any]:
        """What recipes have in common whose vertices are the same and see the same. None: refined, its own alone."""
        if self.options.get("refine", "off" if self.is_published else "auto") != "off":
            return None
        return [self._mesh_key(), self.is_published, self.options.get("visibility_size")]

    def scene(self, mesh: Path) -> relume.Scene:
        scene = relume.Scene().add(mesh, self.material, up=self.model.up)
        if self.ground:
            scene.add_ground(tessellation=self.ground)
        return scene

    def _mesh_key(self) -> Any:
        return [self.model.hash, self.model.up, self.triangles, self.ground]


def write_obj(path: Path, mesh: relume.Mesh) -> None:
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in mesh.positions]
    lines += [f"f {a} {b} {c}" for a, b, c in mesh.triangles + 1]
    with replacing(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n")


class Bakes:
    """Those in a folder, of one program and device."""

    def __init__(self, folder: Path, program: Program, identity: Any) -> None:
        self._folder, self._program, self._identity = folder, program, identity

    def make(self, recipe: Recipe) -> Path:
        """The bake's file: made unless it is there, with the visibility that an earlier one of the same mesh kept."""
        path = self._path(recipe.key())
        if path.exists():
            return path
        output, visibility, arguments = self._output(path), self._visibility(recipe), []
        if visibility and visibility.exists():
            if not output.exists():
                os.link(visibility, output)  # a bake over a file that keeps visibility uses it
        elif visibility:
            arguments = ["--keep-visibility"]
        self._bake(recipe, path, arguments)
        if arguments:
            os.link(path, visibility)
        return path

    def make_timed(self, recipe: Recipe) -> dict:
        """Bakes from nothing. Returns what `relume bake --timings` writes: milliseconds a vertex, by stages too."""
        self.remove(recipe)
        path = self._path(recipe.key())
        timings = path.with_suffix(".timings.json")
        self._bake(recipe, path, ["--timings", timings])
        times = json.loads(timings.read_text())
        timings.unlink()
        return times

    def plan(self, recipe: Recipe) -> relume.Asset:
        """The asset without transport, for references."""
        mesh = self._mesh(recipe)
        return relume.plan(recipe.scene(mesh), **recipe.options)

    def remove(self, recipe: Recipe) -> None:
        path = self._path(recipe.key())
        for file in (path, self._output(path), self._output(path).with_name(self._output(path).name + ".checkpoint")):
            file.unlink(missing_ok=True)

    def remove_visibility(self, recipe: Recipe) -> None:
        if visibility := self._visibility(recipe):
            visibility.unlink(missing_ok=True)

    def remove_meshes(self) -> None:
        for mesh in self._folder.glob("*.obj"):
            mesh.unlink()

    def _bake(self, recipe: Recipe, path: Path, arguments: list) -> None:
        options = [text for name, value in recipe.options.items() for text in (f"--{name.replace('_', '-')}", value)]
        ground = ["--ground", "--ground-tessellation", recipe.ground] if recipe.ground else []
        self._program.run("bake", self._mesh(recipe), "--up", recipe.model.up, "-m", recipe.material, *ground, *options,
                          *arguments, "-o", self._output(path))
        os.replace(self._output(path), path)

    def _mesh(self, recipe: Recipe) -> Path:
        if not recipe.triangles:
            return recipe.model.file
        path = self._folder / f"{recipe.model.hash}-{recipe.triangles}.obj"
        if not path.exists():
            write_obj(path, relume.Mesh.load(recipe.model.file).simplified(recipe.triangles))
        return path

    def _path(self, key: Any) -> Path:
        self._folder.mkdir(parents=True, exist_ok=True)
        return self._folder / f"{hash_of([self._identity, key])}.relume"

    def _visibility(self, recipe: Recipe) -> Optional[Path]:
        key = recipe.visibility_key()
        return self._path(["visibility", key]) if key else None

    @staticmethod
    def _output(path: Path) -> Path:
        """What a bake writes to until it is whole."""
        return path.with_suffix(".part.relume")
