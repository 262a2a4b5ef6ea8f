"""Images of one view under one light, from one bake or several, held against one reference."""

import dataclasses
from typing import Any, Optional, Sequence

import numpy as np

import relume

from . import plots
from .bakes import Recipe
from .evaluation import Results, Step, Work, picture
from .measures import MeasuredError, exposure_of, measured_error, noise_of, refine
from .report import Picture, Pictures
from .scenes import LightChoice, Scale


@dataclasses.dataclass
class FigureImage:
    name: str  # a file's
    title: str  # of the picture
    recipe: Recipe
    terms: Optional[int] = None  # of the bake's K; None: all
    threshold: Optional[int] = None  # of light coefficients; None: the default selection
    is_compared: bool = True  # whether the reference is its truth
    is_shown: bool = True

    def key(self) -> Any:
        return [self.name, self.terms, self.threshold, self.is_compared, self.is_shown]


@dataclasses.dataclass
class Figure:
    name: str  # of its steps
    title: str
    scale: Scale
    light: LightChoice
    images: list[FigureImage]  # those of one recipe side by side
    is_tall: bool = False
    azimuth: float = 30  # degrees
    elevation: float = 20
    distance: float = 1  # just fits the object
    truth: int = 0  # the image whose scene the reference is made of

    @property
    def size(self) -> tuple[int, int]:
        return self.scale.tall if self.is_tall else self.scale.wide

    @property
    def reference(self) -> str:
        return f"{self.name}-reference"

    def camera(self, asset: relume.Asset) -> relume.Camera:
        return relume.Camera.orbit(asset, self.azimuth, self.elevation, self.distance,
                                   aspect=self.size[0] / self.size[1])

    def key(self) -> Any:
        return [self.azimuth, self.elevation, self.distance, self.is_tall, self.light.key]

    def bakes(self) -> list[list[FigureImage]]:
        """The images of each recipe."""
        groups: list[list[FigureImage]] = []
        for image in self.images:
            if not groups or groups[-1][0].recipe.key() != image.recipe.key():
                groups.append([])
            groups[-1].append(image)
        return groups

    def step_of(self, name: str) -> str:
        """The step that drew the image of this name."""
        group = next(group for group in self.bakes() if any(image.name == name for image in group))
        return f"{self.name}-{group[0].name}"


def figure_steps(figure: Figure) -> list[Step]:
    """A step for each bake, and one for reference and errors."""
    steps = [Step(f"{figure.name}-{group[0].name}", f"{figure.title}: {group[0].title}",
                  [figure.key(), [image.key() for image in group]],
                  lambda work, group=group: _draw(work, figure, group), [group[0].recipe])
             for group in figure.bakes()]

    def compare(work: Work) -> Any:
        images = [work.load(figure.step_of(image.name), image.name) for image in figure.images]
        return _compare(work, figure, work.asset(recipe), images)
    recipe = figure.images[figure.truth].recipe
    inputs = [figure.key(), figure.truth, [image.key() for image in figure.images]]
    return [*steps, Step(figure.reference, f"{figure.title}: reference", inputs, compare, [recipe], steps)]


def traced_step(figure: Figure) -> Step:
    """One for images that are traced as the reference is, with the first terms of the BRDFs: what these alone lose.

    Nothing is baked. All are of the first image's recipe. For light of few texels: every one costs 16 rays a pixel.
    """
    recipe = figure.images[0].recipe

    def trace(work: Work) -> Any:
        asset = work.bakes.plan(recipe)
        images = [relume.reference(asset, figure.light.make(), figure.camera(asset), figure.size, samples=1,
                                   brdf="factored", rays=16, terms=image.terms) for image in figure.images]
        return _compare(work, figure, asset, images)
    return Step(figure.reference, f"{figure.title}: terms alone",
                [figure.key(), recipe.key(), [image.key() for image in figure.images]], trace)


def _draw(work: Work, figure: Figure, images: Sequence[FigureImage]) -> Any:
    """Draws the images of one bake. Returns what the bake takes."""
    recipe = images[0].recipe
    asset = work.asset(recipe)
    renderer = relume.Renderer(asset, figure.size, samples=1, residual=not recipe.is_published)
    light = figure.light.make()
    for image in images:
        renderer.select_light(threshold=image.threshold)
        renderer.select_terms(image.terms)
        work.write(figure.step_of(image.name), image.name, renderer.render(light, figure.camera(asset)))
    total = work.program.json("info", work.bakes.make(recipe))["total"]
    return {"vertices": total["vertices"], "bytes_per_vertex": total["bytes_per_vertex"]}


def _compare(work: Work, figure: Figure, asset: relume.Asset, images: Sequence[np.ndarray]) -> Any:
    """Holds the images, as many as the figure has, against the reference, for which transport is not needed."""
    reference = relume.SampledReference(asset, figure.light.make(), figure.camera(asset), figure.size,
                                        face_size=figure.light.face_size)
    compared = [pixels for image, pixels in zip(figure.images, images) if image.is_compared]
    refine(reference, compared, figure.scale.noise, figure.scale.passes)
    truth, halves = reference.mean(), reference.halves()
    exposure = exposure_of(truth)
    work.write(figure.reference, "reference", truth)
    work.write(figure.reference, "reference", truth, exposure)
    errors = {}
    for image, pixels in zip(figure.images, images):
        if image.is_shown:
            work.write(figure.reference, image.name, pixels, exposure)
        if image.is_compared:
            errors[image.name] = dataclasses.asdict(measured_error(pixels, halves))
        if image.is_compared and image.is_shown:
            with work.writing(figure.reference, f"{image.name}-error.png") as temporary:
                plots.write_heat(temporary, pixels, truth)
    return {"passes": reference.passes, "noise": noise_of(halves), "exposure": exposure, "errors": errors}


def error_of(figure: Figure, results: Results, image: str) -> MeasuredError:
    return MeasuredError(**results[figure.reference]["errors"][image])


def pictures_of(figure: Figure, results: Results, title: str, remark: str = "") -> Pictures:
    """The images with their errors, the reference last; below them the differences."""
    numbers = results[figure.reference]
    shown = [image for image in figure.images if image.is_shown]
    pictures = [Picture(picture(figure.reference, f"{image.name}.png"), image.title,
                        str(error_of(figure, results, image.name)) if image.is_compared else "") for image in shown]
    pictures.append(Picture(picture(figure.reference, "reference.png"), "reference",
                            f"{numbers['passes']} samples a pixel"))
    columns = len(pictures)
    pictures += [Picture(picture(figure.reference, f"{image.name}-error.png"), "", f"error of {image.title}")
                 for image in shown if image.is_compared]
    note = (f"Exposure {numbers['exposure']:+.1f} stops; noise left in the reference {100 * numbers['noise']:.2f} %. "
            f"Errors: black none, yellow {100 * plots.HEAT_RANGE:.0f} % of the reference's mean luminance or more.")
    return Pictures(title, columns, pictures, f"{remark} {note}".strip())
