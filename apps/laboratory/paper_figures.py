"""The paper's figures: terms, coefficients, BRDFs, maps, and its scenes."""

import dataclasses
from typing import Any, Optional

from . import plots
from .evaluation import Results, Section, Step, Work, picture, skipped
from .figures import Figure, FigureImage, error_of, figure_steps, pictures_of, traced_step
from .measures import are_distinguishable, range_text
from .report import Chapter, Picture, Pictures, Plot, Table
from .scenes import (ALL_COEFFICIENTS, ASHIKHMIN_SHIRLEY, PAPER_THRESHOLD, Setup, area_light, default_options,
                     distant_light, environment_light, paper_options, scene_recipe)


def figure_2(setup: Setup) -> Section:
    """How many terms a BRDF takes, seen on its highlights."""
    title, model = "Figure 2: the number of BRDF terms", setup.inputs.model("buddha")
    if not model:
        return skipped(title, "there is no Buddha")
    most = setup.scale.terms
    counts = [1 << power for power in range(most.bit_length())]

    def figure_of(name: str, options: dict[str, Any]) -> Figure:
        # No ground: its error would hide that of the highlights.
        recipe = scene_recipe(setup, "buddha", model, ASHIKHMIN_SHIRLEY, options, has_ground=False)
        images = [FigureImage(f"k{terms}", f"K = {terms}", recipe, terms) for terms in counts]
        return Figure(name, "Figure 2", setup.scale, distant_light(20, 45), images, is_tall=True)
    relit = figure_of("figure-2", paper_options(most))
    traced = figure_of("figure-2-terms", paper_options(most))
    # Nested: the first k of these terms are the factorization into k.
    weighed = figure_of("figure-2-environment", default_options(terms=most, factorization="environment"))

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "The paper shows the Buddha in Ashikhmin and Shirley's BRDF (kd 0.5, ks 0.75, nu 10, nv 100) under a "
            "single distant light, and finds four terms visually accurate. Here the first K terms of the paper's "
            "factorization, maps of 48 x 48; the reference has the analytic BRDF under the same light, in the texels "
            "of 6 x 64². There is no ground, so that the error is that of the highlights.")
        chapter.say(setup.scale.note)
        chapter.say("The terms alone: rays find what the light reaches, and nothing is lost but by the BRDF's "
                    "approximation.")
        chapter.items.append(pictures_of(traced, results, f"{model}, terms alone"))
        chapter.say("The same of the factorization that weighs what light and pixels ask for "
                    "(--factorization environment), in equal-area maps.")
        chapter.items.append(pictures_of(weighed, results, f"{model}, terms alone, weighed"))
        chapter.say("As it is relit from one bake in the paper's way, but with relume's choice of 1,024 coefficients of "
                    "the light. What this adds comes from rows of 96 coefficients, which a single direction needs all "
                    "of, the simplified occluder and interpolation.")
        chapter.items.append(pictures_of(relit, results, f"{model}, relit"))
        chapter.items.append(Table(
            "figure_2", "Relative RMSE over K",
            ["terms K", "the paper's terms alone (interval)", "terms weighed by environments alone (interval)",
             "relit (interval)"],
            [[image.title, *(str(error_of(figure, results, image.name)) for figure in (traced, weighed, relit))]
             for image in relit.images]))

        def percents(terms: int) -> list[str]:
            return [f"{100 * error_of(figure, results, f'k{terms}').value:.0f} %" for figure in (traced, weighed)]
        four, all_terms = percents(4), percents(most)
        chapter.findings.append(
            "Figure 2: under a single direction four terms of the paper's factorization alone leave an error of "
            f"{four[0]}, of terms weighed by environments {four[1]}; {most} terms {all_terms[0]} and {all_terms[1]}.")

    return Section(title, [*figure_steps(relit), traced_step(traced), traced_step(weighed)], write)


def figure_3(setup: Setup) -> Section:
    """How many wavelet coefficients a shadow takes."""
    title, model = "Figure 3: the number of wavelet coefficients", setup.inputs.model("bunny")
    if not model:
        return skipped(title, "there is no bunny")
    # Lossless transport of the paper's 148 quads a side would not fit on a device.
    quads = setup.scale.ground or 96
    images = []
    for coefficients in (64, 96, 160, 256, ALL_COEFFICIENTS):
        options = paper_options(1, coefficients=coefficients)
        recipe = dataclasses.replace(scene_recipe(setup, "bunny", model, "gray-diffuse", options), ground=quads)
        what = "lossless" if coefficients == ALL_COEFFICIENTS else f"N = {coefficients}"
        images += [FigureImage(f"n{coefficients}", what, recipe, threshold=PAPER_THRESHOLD),
                   FigureImage(f"n{coefficients}-all-light", what, recipe, threshold=0, is_shown=False)]
    light = area_light(60, 38, 3)
    figure = Figure("figure-3", "Figure 3", setup.scale, light, images, azimuth=-20, elevation=40, distance=1.25)

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "The paper varies how many coefficients a transport vector keeps, and finds 96 to give visually good "
            f"shadows. The same here, for a diffuse bunny under {light.name} on a ground of {(quads + 1) ** 2} "
            "vertices, the same for all N: coarser than the paper's 22K, since lossless transport of these would be "
            "too large for a device. What lossless transport leaves is the ground's vertices being far apart, and a "
            f"light of 6 x 64² texels held against a reference of 6 x {light.face_size}², and shadows of a simplified "
            "occluder.")
        chapter.say(setup.scale.note)
        chapter.items.append(pictures_of(figure, results, str(model)))
        chapter.items.append(Table(
            "figure_3", "Relative RMSE over N",
            ["coefficients", "RMSE, light threshold 1024", "RMSE, all of the light", "bytes per vertex"],
            [[kept.title, str(error_of(figure, results, kept.name)), str(error_of(figure, results, everything.name)),
              f"{results[figure.step_of(kept.name)]['bytes_per_vertex']:.0f}"]
             for kept, everything in zip(images[::2], images[1::2])],
            "All vertices, of the object and the ground, have one term. Lossless: all 24,576 coefficients, but for "
            "those that are zero in 11 bits."))

    return Section(title, figure_steps(figure), write)


_BRDFS = (("ashikhmin-shirley", "Ashikhmin-Shirley", "grace"), ("brown-plastic", "light brown plastic", "rnl"),
          ("clay", "clay (Lafortune)", "stpeters"), ("skin", "dark skin (Lafortune)", "grace"))
_MAP_SIZES = (16, 32, 48, 64)
_SHEET_SIZE = 48


def figure_4(setup: Setup) -> Section:
    """BRDFs factored: their maps, their errors, and what they look like."""
    terms = setup.scale.terms

    def step_of(material: str, name: str) -> Step:
        step = f"figure-4-{material}"

        def work(work: Work) -> Any:
            errors = {}
            for size in _MAP_SIZES:
                arguments = ["brdf", material, "--factorization", "paper", "-K", terms, "--size", size]
                if size == _SHEET_SIZE:
                    with work.writing(step, "maps.png") as temporary:
                        errors[f"{size}"] = work.program.json(*arguments, "--maps", temporary)["rms_absolute"]
                else:
                    errors[f"{size}"] = work.program.json(*arguments)["rms_absolute"]
            return errors
        return Step(step, f"Figure 4: {name}", terms, work)
    steps = [step_of(material, name) for material, name, _ in _BRDFS]
    bunnies = []
    if model := setup.inputs.model("bunny"):
        for material, name, environment in _BRDFS:
            if light := setup.inputs.environment(environment):
                recipe = scene_recipe(setup, "bunny", model, material, paper_options(4), has_ground=False)
                bunnies.append(Figure(f"figure-4-bunny-{material}", f"Figure 4: {name} bunny under {light}",
                                      setup.scale, environment_light(light), [FigureImage("k4", "K = 4", recipe)],
                                      azimuth=-20, elevation=12))
    for bunny in bunnies:
        steps += figure_steps(bunny)

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            f"The first eight light maps (S = {_SHEET_SIZE}) of the paper's four BRDFs in its factorization: each "
            "scaled by its own largest magnitude, magenta where negative. The two Lafortune fits are the paper's kind; "
            "the plastics are ours, as the paper does not give its parameters.")
        chapter.items.append(Pictures("First eight terms", 2, [
            Picture(picture(f"figure-4-{material}", "maps.png"), name) for material, name, _ in _BRDFS]))
        errors = {material: results[f"figure-4-{material}"] for material, _, _ in _BRDFS}
        panels = [plots.Panel(name, [plots.curve_of_terms(f"S = {size}", errors[material][f"{size}"], color)
                                     for color, size in enumerate(_MAP_SIZES)]) for material, name, _ in _BRDFS]
        chapter.items.append(Plot("figure_4", "RMS over the number of terms", lambda path: plots.draw_lines(
            path, "RMS error, weighted by cosines", "terms K", "RMS of f cos cos", panels,
            ticks=range(0, terms + 1, max(1, terms // 4)))))
        counts = [1 << power for power in range(terms.bit_length())]
        chapter.items.append(Table(
            "figure_4", "RMS of f cos θi cos θo over K and S", ["BRDF", "S", *(f"K = {count}" for count in counts)],
            [[name, f"{size}", *(f"{errors[material][f'{size}'][:count][-1]:.4f}" for count in counts)]
             for material, name, _ in _BRDFS for size in _MAP_SIZES],
            "Of 80,000 random pairs of directions, mean over color channels. The paper plots such curves weighted by "
            "cos θi, without numbers; and sees that beyond S = 32 little is gained."))
        chapter.say(
            "Where a larger S does worse: f grows steeply towards grazing angles, how near to the horizon the "
            "outermost centers of a map fall is a matter of chance, and at S = 64 the first terms of "
            "Ashikhmin-Shirley describe these.")
        if bunnies:
            chapter.say("Bunnies from bakes in the paper's way, lit by relume's choice of 1,024 coefficients.")
        chapter.items += [pictures_of(bunny, results, bunny.title) for bunny in bunnies]

    return Section("Figure 4: BRDFs factored", steps, write)


def figure_5(setup: Setup) -> Section:
    """Diffuse, one polar term, four terms."""
    title = "Figure 5: one term against four"
    model, light = setup.inputs.model("lucy"), setup.inputs.environment("grace")
    if not model or not light:
        return skipped(title, "there is no Lucy or no Grace Cathedral")

    def image(name: str, what: str, options: dict[str, Any], material: str = ASHIKHMIN_SHIRLEY,
              **others: Any) -> FigureImage:
        return FigureImage(name, what, scene_recipe(setup, "lucy", model, material, options), **others)
    polar = paper_options(1, map="polar-sine")
    figure = Figure("figure-5", "Figure 5", setup.scale, environment_light(light), [
        image("diffuse", "gray diffuse", paper_options(1), "gray-diffuse", is_compared=False),
        image("polar", "one term, polar map", polar),
        image("normalized", "one term, polar map, normalized decomposition", {**polar, "factorization": "normalized"}),
        image("terms", "four terms", paper_options(4)),
        image("one", "one term, orthographic map", paper_options(4), terms=1, is_shown=False),
    ], is_tall=True, truth=3)

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "Lucy in gray diffuse, in a single term of Ashikhmin-Shirley from polar maps, and in four terms from "
            f"orthographic ones; under {light}, the paper's light not being known, in relume's choice of 1,024 "
            "coefficients. Bakes are in the paper's way. The reference is of Ashikhmin-Shirley.")
        chapter.say(setup.scale.note)
        chapter.items.append(pictures_of(figure, results, str(model)))
        chapter.items.append(Table("figure_5", "Relative RMSE", ["maps", "RMSE (interval)"],
                                   [[image.title, str(error_of(figure, results, image.name))]
                                    for image in figure.images if image.is_compared]))
        chapter.say("In our reading, the polar map has the azimuth along x and the sine of the angle from the normal "
                    "along y.")

    return Section(title, figure_steps(figure), write)


@dataclasses.dataclass(frozen=True)
class _Scene:
    """One of the paper's pictures."""
    name: str
    title: str
    model: str
    material: str
    environment: Optional[str]  # None: a small area light
    azimuth: float = 30
    is_tall: bool = True
    instead: Optional[str] = None  # the environment that is used where that one is missing


_SCENES = (
    _Scene("dragon", "Figure 1, left: dragon, Ashikhmin-Shirley", "dragon", ASHIKHMIN_SHIRLEY, "uffizi", -20, False,
           "grace"),
    _Scene("bunny", "Figure 1, right: bunny, red plastic", "bunny", "red-plastic", "grace", -20, False),
    _Scene("buddha", "Figure 6, left: Buddha, Ashikhmin-Shirley", "buddha", ASHIKHMIN_SHIRLEY, "stpeters", 0),
    _Scene("lucy-area", "Figure 6, right: Lucy, Ashikhmin-Shirley", "lucy", ASHIKHMIN_SHIRLEY, None),
    _Scene("lucy-brown", "Figure 7: Lucy, light brown plastic", "lucy", "brown-plastic", "rnl"),
)


_PAPER, _DEFAULTS = "the paper's way is closer", "the defaults are closer"


def scenes(setup: Setup) -> Section:
    """The scenes of figures 1, 6 and 7, under environments and a small lamp."""
    title = "Figures 1, 6 and 7: scenes under all-frequency light"
    figures: list[tuple[Figure, str, str]] = []  # with a title and a remark
    for scene in _SCENES:
        model, remark = setup.inputs.model(scene.model), ""
        light = area_light(75, 35, 3)
        if scene.environment:
            found = setup.inputs.environment(scene.environment)
            if not found and scene.instead and (found := setup.inputs.environment(scene.instead)):
                remark = "Not the paper's light, which is missing."
            light = environment_light(found) if found else None
        if not model or not light:
            continue
        if model.stands_for:
            remark += f" {model}."

        def image(name: str, what: str, options: dict[str, Any], threshold: Optional[int] = None) -> FigureImage:
            return FigureImage(name, what, scene_recipe(setup, scene.model, model, scene.material, options),
                               threshold=threshold)
        figures.append((Figure(f"scenes-{scene.name}", scene.title, setup.scale, light, [
            image("paper", "the paper's way", paper_options(4), PAPER_THRESHOLD),
            image("default", "relume's defaults", default_options()),
        ], scene.is_tall, scene.azimuth, 15, 1.1), f"{scene.title}, under {light.name}", remark))
    if not figures:
        return skipped(title, "there is none of its models and environments")

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "Each in the paper's way (its factorization, K = 4, rows of 96 coefficients, the light above its threshold "
            "of 1024), with relume's defaults for direct light without refinement (K = 8, of anisotropic materials "
            "9, bases, 1,024 coefficients of the light), and the reference: exact BRDF, full mesh, light of 6 x 256² "
            "texels.")
        chapter.say(setup.scale.note)
        rows, errors = [], []
        for figure, name, remark in figures:
            chapter.items.append(pictures_of(figure, results, name, remark))
            paper, default = (error_of(figure, results, way) for way in ("paper", "default"))
            verdict = ("not distinguishable" if not are_distinguishable(paper, default) else
                       _PAPER if paper.value < default.value else _DEFAULTS)
            errors.append((100 * paper.value, 100 * default.value))
            rows.append([name, str(paper), str(default), verdict])
        chapter.items.append(Table("scenes", "Relative RMSE", ["scene", "the paper's way", "defaults", ""], rows))
        papers, defaults = zip(*errors)
        verdicts = [row[-1] for row in rows]
        chapter.findings.append(
            f"Figures 1, 6 and 7: the paper's way leaves errors of {range_text(papers)} %, relume's defaults "
            f"{range_text(defaults)} %. Of {len(figures)} scenes the defaults are closer to the reference in "
            f"{verdicts.count(_DEFAULTS)}, the paper's way in {verdicts.count(_PAPER)}.")

    return Section(title, [step for figure, _, _ in figures for step in figure_steps(figure)], write)
