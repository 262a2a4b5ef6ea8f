"""How large scenes and images are, in full and with --quick; lights, and the paper's four models."""

import dataclasses
import math
from typing import Any, Callable, Mapping, Optional

import relume

from .bakes import Recipe
from .inputs import Input, Inputs

ASHIKHMIN_SHIRLEY = "ashikhmin-shirley"  # the preset of the paper's Figures 2 and 5
PAPER_THRESHOLD = 1024  # of light coefficients
PAPER_TERMS = (1, 4)
ALL_COEFFICIENTS = 6 * 64 * 64  # N at which nothing is dropped


@dataclasses.dataclass(frozen=True)
class Scale:
    """How much of everything."""
    name: str
    triangles: int  # that models are simplified to; 0: all
    ground: Optional[int]  # quads a side; None: the paper's
    options: Mapping[str, Any]  # of every bake, besides its own
    wide: tuple[int, int]  # pixels
    terms: int  # most, of figures that count them
    noise: float  # of a reference, as a share of the least error
    passes: int  # most, of a reference
    points: tuple[int, int]  # pixels of images whose error is taken apart
    point_passes: int
    rounds: int  # of timed frames
    models: int  # of those whose errors are taken apart

    @property
    def tall(self) -> tuple[int, int]:
        return self.wide[1], self.wide[0]

    @property
    def note(self) -> str:
        """What is smaller than in full, as a sentence."""
        if self == FULL:
            return ""
        return (f"With {self.name}: models simplified to {self.triangles} triangles on grounds of "
                f"{(self.ground + 1) ** 2} vertices, visibility at 6 x {self.options['visibility_size']}² instead of "
                f"6 x 256², images of {self.wide[0]} x {self.wide[1]} pixels, fewer samples.")


FULL = Scale("full", 0, None, {}, (640, 480), 32, 0.15, 256, (120, 90), 1024, 15, 3)
QUICK = Scale("--quick", 5000, 40, {"visibility_size": 128}, (320, 240), 16, 0.3, 64, (64, 48), 256, 5, 1)


@dataclasses.dataclass
class Setup:
    """What sections are made of."""
    inputs: Inputs
    scale: Scale


@dataclasses.dataclass(frozen=True)
class PaperModel:
    """Tables 1 and 2 of the paper, by PAPER_TERMS where there are two numbers."""
    name: str
    vertices: int
    ground: int  # vertices
    minutes: tuple[float, float]  # of a bake
    megabytes: tuple[float, float]  # 10^6 bytes
    view_fps: tuple[float, float]
    light_fps: tuple[float, float]

    @property
    def all_vertices(self) -> int:
        return self.vertices + self.ground


PAPER_MODELS = (
    PaperModel("bunny", 36000, 22000, (21, 70), (30, 84), (90, 63), (20, 7.2)),
    PaperModel("buddha", 56000, 31000, (35, 101), (44, 127), (46, 35), (14, 5.0)),
    PaperModel("dragon", 100000, 63000, (70, 194), (81, 230), (24, 18), (7.8, 2.7)),
    PaperModel("lucy", 180000, 23000, (80, 233), (100, 370), (18, 12), (6.2, 1.7)),
)
_GROUND_QUADS = {"bunny": 148, "buddha": 175, "dragon": 250, "lucy": 151}  # a side: the paper's vertices


@dataclasses.dataclass(frozen=True)
class PaperScene:
    model: PaperModel
    input: Input


def paper_scenes(setup: Setup) -> list[PaperScene]:
    """Those whose meshes are there; nothing stands in for the others."""
    found = [(model, setup.inputs.model(model.name)) for model in PAPER_MODELS]
    return [PaperScene(model, input) for model, input in found if input and not input.stands_for]


def paper_options(terms: int, **others: Any) -> dict[str, Any]:
    """Options of a bake in the paper's way."""
    return {"preset": "paper", "terms": terms, **others}


def default_options(**others: Any) -> dict[str, Any]:
    """Relume's defaults, but for refinement and bounces: vertices and light are the paper's."""
    return {"refine": "off", "bounces": 0, **others}


def scene_recipe(setup: Setup, model: str, found: Input, material: str, options: dict[str, Any],
                 has_ground: bool = True) -> Recipe:
    """The model on the ground that the paper tessellates for it, or as small as the scale has it."""
    ground = (setup.scale.ground or _GROUND_QUADS[model]) if has_ground else None
    return Recipe(str(found), found, material, {**options, **setup.scale.options}, ground, setup.scale.triangles)


def paper_recipe(setup: Setup, scene: PaperScene, terms: int) -> Recipe:
    return scene_recipe(setup, scene.model.name, scene.input, ASHIKHMIN_SHIRLEY, paper_options(terms))


@dataclasses.dataclass(frozen=True)
class LightChoice:
    """A light that is made when a step needs it; key: what decides it."""
    name: str
    key: Any
    make: Callable[[], relume.Light]
    face_size: int = 256  # texels a side of the cube in which the reference has it


def environment_light(input: Input) -> LightChoice:
    return LightChoice(str(input), input.hash, lambda: relume.Light.environment(input.file))


def area_light(azimuth: float, elevation: float, radius: float) -> LightChoice:
    """A white lamp that lights a surface facing it to radiance 1 of a white diffuse BRDF. In degrees."""
    radiance = 1 / math.sin(math.radians(radius)) ** 2
    return LightChoice(f"an area light of {radius:g} degrees' radius", [azimuth, elevation, radius],
                       lambda: relume.Light.lamp(azimuth, elevation, radius, [radiance] * 3))


def distant_light(azimuth: float, elevation: float) -> LightChoice:
    """A single direction, as bright; in the truth, too, it is one of the bake's 6 x 64² texels."""
    return LightChoice("a distant light", [azimuth, elevation],
                       lambda: relume.Light.distant(azimuth, elevation, [math.pi] * 3), face_size=64)
