"""Where error comes from: every stage made exact in turn, low-order harmonics instead, and refined grounds."""

import dataclasses
from typing import Any

import numpy as np

import relume

from .bakes import Recipe
from .evaluation import Results, Section, Step, Work, picture, skipped
from .inputs import Input
from .measures import exposure_of, range_text
from .plots import write_display
from .report import Chapter, Picture, Pictures, Table
from .scenes import FULL, Scale, Setup, default_options, paper_options, scene_recipe

_MODELS = ("bunny", "dragon", "lucy")
_MATERIALS = ("ashikhmin-shirley", "red-plastic", "clay")
_ENLARGED = 3  # pixels of a pixel


def _camera(asset: relume.Asset, scale: Scale, elevation: float) -> relume.Camera:
    return relume.Camera.orbit(asset, 30, elevation, aspect=scale.points[0] / scale.points[1])


def sources(setup: Setup) -> Section:
    """Where error comes from, and what 25 spherical harmonics would leave."""
    title, scale = "Where error comes from", setup.scale
    lights = setup.inputs.environments(("grace", "stpeters", "rnl"))
    models = [(name, setup.inputs.model(name)) for name in _MODELS[:scale.models]]
    studies: list[tuple[str, Input, str]] = []  # step, model, material
    steps = []

    def study(work: Work, name: str, recipe: Recipe) -> Any:
        asset = work.asset(recipe)
        numbers = relume.errors(asset, [relume.Light.environment(light.file) for light in lights],
                                _camera(asset, scale, 15), scale.points, passes=scale.point_passes, images=True)
        for number, result in enumerate(numbers):
            images = result.pop("images")
            exposure = exposure_of(images["reference"])
            for image, pixels in images.items():
                if image in ("drawn", "reference", "harmonics"):
                    enlarged = np.repeat(np.repeat(pixels, _ENLARGED, axis=0), _ENLARGED, axis=1)
                    work.write(name, f"{number}-{image}", pixels)
                    work.write(name, f"{number}-{image}", enlarged, exposure)
                else:
                    with work.writing(name, f"{number}-{image}.png") as temporary:
                        write_display(temporary, pixels, _ENLARGED)
        return numbers
    for model_name, model in models:
        if not model or not lights:
            continue
        for material in _MATERIALS:
            name = f"sources-{model_name}-{material}"
            recipe = scene_recipe(setup, model_name, model, material, default_options())
            studies.append((name, model, material))
            steps.append(Step(name, f"Sources of error: {model}, {material}", [light.hash for light in lights],
                              lambda work, name=name, recipe=recipe: study(work, name, recipe), [recipe]))
    if not steps:
        return skipped(title, "there is none of its models and environments")

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "Each point of an image is computed again, stage after stage made exact: first with light that nothing "
            "shadows summed instead of looked up in lit spheres, then with all of the light's coefficients, then "
            "transport as it was before it was stored, then all its coefficients, its own instead of its triangle's "
            "corners', all terms of the tabulated BRDF, the BRDF itself, taken as finely as rays are cast, the light's "
            "own resolution, the full mesh, and 6 x 512² rays. What a stage changes is the error of what it replaces. "
            "Baked with relume's defaults for direct light, without refinement.")
        chapter.say(scale.note)
        _add_error_tables(chapter, [([str(model), material, light.name], numbers) for name, model, material in studies
                                    for light, numbers in zip(lights, results[name])])
        for name, model, material in studies:
            shown = {"drawn": "drawn", "reference": "reference", "harmonics": "25 spherical harmonics",
                     "total": "all error"}
            shown.update({source: values["title"] for source, values in results[name][0]["sources"].items()})
            chapter.items.append(Pictures(
                f"{model}, {material}, {lights[0]}", 5,
                [Picture(picture(name, f"0-{image}.png"), caption) for image, caption in shown.items()],
                "Full heat is the total error that one point in a hundred exceeds, in all maps alike."))

    return Section(title, steps, write)


def _percent(share: float) -> str:
    return f"{100 * share:.2f} %"


def _add_error_tables(chapter: Chapter, scenes: list[tuple[list[str], dict[str, Any]]]) -> None:
    """Of scenes, by model, material and environment, and what relume.errors() says of them."""
    columns = ["model", "material", "environment"]
    titles = [source["title"] for source in scenes[0][1]["sources"].values()]
    chapter.items += [
        Table("error-sums", "How the sources add up",
              [*columns, "measured", "sources, summed", "ratio", "were they independent", "reference's noise",
               "not accounted for"],
              [[*scene, _percent(numbers["measured"]), _percent(numbers["total"]),
                f"{numbers['total'] / numbers['measured']:.3f}" if numbers["measured"] > 0 else "-",
                *(_percent(numbers[key]) for key in ("root_sum_of_squares", "reference_noise", "unexplained_truth"))]
               for scene, numbers in scenes],
              "Measured: the device's image against the sampled reference. Summed: the changes of all sources, point "
              "by point; independent: the root of the sum of their squares. Not accounted for: of the reference."),
        Table("error-sources", "Where error comes from", [*columns, *titles],
              [[*scene, *(f"{100 * source['rms']:.2f}\u00a0({round(100 * source['share'])})"
                          for source in numbers["sources"].values())] for scene, numbers in scenes],
              "The change by each source in percent of the truth, root mean square; in brackets its share of the "
              "squared total in percent, below 0 where it makes up for others."),
        Table("error-harmonics", "Against 25 spherical harmonics",
              [*columns, "relume", "harmonics, same K terms", "harmonics, exact BRDF"],
              [[*scene, *(_percent(numbers[key])
                          for key in ("measured", "spherical_harmonics_of_terms", "spherical_harmonics"))]
               for scene, numbers in scenes],
              "Harmonics: the environment in those of degrees 0 to 4 alone; shadows exact, nothing interpolated or "
              "stored; of relume's K terms, and of the exact BRDF.")]
    measured = [numbers for _, numbers in scenes if numbers["measured"] > 0]
    if not measured:
        return
    sums = [numbers["total"] / numbers["measured"] for numbers in measured]
    harmonics = [numbers["spherical_harmonics_of_terms"] / numbers["measured"] for numbers in measured]
    chapter.findings.append(
        f"Sources of error: over {len(sums)} scenes their sum is {sum(sums) / len(sums):.3f} of the measured error in "
        f"the mean, and {max(sums, key=lambda ratio: abs(ratio - 1)):.3f} where it is furthest from 1. 25 spherical "
        f"harmonics with the same terms leave {range_text(harmonics)} times relume's error.")


_UNIFORM = (37, 74, 148)  # quads a side
_REFINED = (0.014, 0.01, 0.0085, 0.007)  # --refine
_COARSE_QUADS = 16  # that grounds are refined from


def refinement(setup: Setup) -> Section:
    """Refined grounds against uniform ones."""
    title, scale = "Vertices where shadows end", setup.scale
    model, lights = setup.inputs.model("bunny"), setup.inputs.environments(("rnl", "grace", "stpeters"))
    if not model or not lights:
        return skipped(title, "there is no bunny, or none of its environments")

    def study(work: Work, recipe: Recipe) -> Any:
        asset = work.asset(recipe)
        # References are for whole images: here only what interpolation changes is asked for.
        numbers = relume.errors(asset, [relume.Light.environment(light.file) for light in lights],
                                _camera(asset, scale, 25), scale.points, passes=0)
        return {"vertices": asset.info()["parts"][-1]["vertices"],
                "errors": [result["parts"][-1]["sources"]["interpolation"]["rms"] for result in numbers]}

    def step_of(name: str, ground: str, quads: int, options: dict[str, Any]) -> tuple[str, Step]:
        recipe = dataclasses.replace(scene_recipe(setup, "bunny", model, "white-diffuse", options), ground=quads)
        return ground, Step(f"refinement-{name}", f"Refinement: the bunny's ground, {ground}",
                            [light.hash for light in lights], lambda work: study(work, recipe), [recipe])
    uniform = [step_of(f"uniform-{quads}", f"{quads} x {quads} quads", quads, paper_options(1)) for quads in _UNIFORM]
    refined = [step_of(f"{1e4 * error:.0f}", f"--refine {error}", _COARSE_QUADS, paper_options(1, refine=error))
               for error in _REFINED]

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "The bunny, white-diffuse like its ground: what interpolation between vertices changes of the ground's "
            "points in an image, relative root mean square (the source \"vertex interpolation\" of the ground alone). "
            f"Uniform grounds, and grounds that were refined to an error over the whole scene, from {_COARSE_QUADS} x "
            f"{_COARSE_QUADS} quads on.")
        if scale != FULL:
            chapter.say(f"With {scale.name} the bunny has fewer triangles, and visibility "
                        f"6 x {scale.options['visibility_size']}².")
        rows = [[ground, f"{results[step.name]['vertices']}", *map(_percent, results[step.name]["errors"])]
                for ground, step in uniform + refined]
        chapter.items.append(Table("refinement", "Vertices against error",
                                   ["ground", "its vertices", *map(str, lights)], rows))
        # The fewest vertices that are as good as the finest uniform ground's under every light.
        finest, finest_step = uniform[-1]
        wanted = results[finest_step.name]
        good = [(results[step.name]["vertices"], ground) for ground, step in refined
                if all(own <= other for own, other in zip(results[step.name]["errors"], wanted["errors"]))]
        if not good:
            chapter.findings.append(f"Refinement: none of the refined grounds is as good as {finest} under every "
                                    "light.")
            return
        vertices, ground = min(good)
        chapter.findings.append(
            f"Refinement: {vertices} vertices ({ground}) interpolate the ground as well as {wanted['vertices']} "
            f"uniform ones under every light: {wanted['vertices'] / vertices:.1f} times fewer.")

    return Section(title, [step for _, step in uniform + refined], write)
