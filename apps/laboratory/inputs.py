"""The meshes and environments that the paper's scenes need: those that are there, and what was looked for."""

import dataclasses
from typing import Optional, Sequence

from .store import Path, file_hash

# Of Debian's packages glmark2-data and blender-data.
_INSTALLED_BUNNY = Path("/usr/share/glmark2/models/bunny.obj")
_INSTALLED_LIGHTS = Path("/usr/share/blender/datafiles/studiolights/world")

_MODELS = {"bunny": "bunny", "buddha": "Buddha", "dragon": "dragon", "lucy": "Lucy"}
_Z_UP = {"buddha"}  # as Stanford's simplified model has it
_ENVIRONMENTS = {  # and Blender's that stands for it
    "grace": ("Grace Cathedral", "interior"),
    "stpeters": ("St Peter's Basilica", "courtyard"),
    "rnl": ("Eucalyptus Grove", "forest"),
    "uffizi": ("Uffizi Gallery", "city"),
}
_MESHES, _MAPS = (".obj", ".ply", ".glb", ".gltf"), (".exr", ".hdr")


@dataclasses.dataclass(frozen=True)
class Input:
    """A file, as the report calls it."""
    name: str
    file: Path
    up: str = "y"
    stands_for: str = ""

    @property
    def hash(self) -> str:
        return file_hash(self.file)

    def __str__(self) -> str:
        return f"{self.name}, standing for {self.stands_for}" if self.stands_for else self.name


class Inputs:
    """What --data and the installed packages have. With stand_ins, what is missing is replaced by what is installed."""

    def __init__(self, data: Optional[Path], stand_ins: bool) -> None:
        self._data, self._stand_ins = data, stand_ins
        self.missing: list[str] = []  # a line each, in the order in which they were asked for

    def model(self, name: str) -> Optional[Input]:
        """"bunny", "buddha", "dragon" or "lucy"."""
        title = _MODELS[name]
        if own := self._in_data("meshes", name, _MESHES):
            return Input(title, own, "z" if name in _Z_UP else "y")
        bunny = self._in_data("meshes", "bunny", _MESHES) or _INSTALLED_BUNNY
        stand_in = None
        if bunny.is_file():
            if name == "bunny":
                return Input(title, bunny)
            if self._stand_ins:
                stand_in = Input("bunny", bunny, stands_for=title)
        also = f" and {_INSTALLED_BUNNY}" if name == "bunny" else ""
        self._miss(title, self._pattern("meshes", name, _MESHES) + also, stand_in)
        return stand_in

    def environment(self, name: str) -> Optional[Input]:
        """"grace", "stpeters", "rnl" or "uffizi"."""
        title, blender = _ENVIRONMENTS[name]
        if own := self._in_data("environments", name, _MAPS):
            return Input(title, own)
        installed, stand_in = _INSTALLED_LIGHTS / f"{blender}.exr", None
        if self._stand_ins and installed.is_file():
            stand_in = Input(f"Blender's {blender}", installed, stands_for=title)
        self._miss(title, self._pattern("environments", name, _MAPS), stand_in)
        return stand_in

    def environments(self, names: Sequence[str]) -> list[Input]:
        """Those of these names that are there."""
        return [found for found in map(self.environment, names) if found]

    def any_environment(self) -> Optional[Input]:
        """The first that is in --data, or one that is installed: for scenes in which any will do."""
        installed = _INSTALLED_LIGHTS / "interior.exr"
        for name, (title, _) in _ENVIRONMENTS.items():
            if own := self._in_data("environments", name, _MAPS):
                return Input(title, own)
        if installed.is_file():
            return Input("Blender's interior", installed)
        self._miss("An environment", str(installed), None)
        return None

    def _in_data(self, folder: str, name: str, extensions: Sequence[str]) -> Optional[Path]:
        """The first file by name that begins so and has one of these extensions."""
        if not self._data or not (self._data / folder).is_dir():
            return None
        files = [path for path in (self._data / folder).iterdir()
                 if path.name.startswith(name) and path.suffix.lower() in extensions and path.is_file()]
        return min(files, default=None)

    def _pattern(self, folder: str, name: str, extensions: Sequence[str]) -> str:
        endings = ",".join(extension[1:] for extension in extensions)
        return f"{self._data or '--data DIR with'}{'/' if self._data else ' '}{folder}/{name}*.{{{endings}}}"

    def _miss(self, title: str, looked_for: str, stand_in: Optional[Input]) -> None:
        instead = f"{stand_in.name} stands for it" if stand_in else "scenes that need it are skipped"
        line = f"{title}: looked for {looked_for}; {instead}"
        if line not in self.missing:
            self.missing.append(line)
