"""Tables 1 and 2, and the layouts of now at equal bytes and at equal time."""

import dataclasses
from typing import Any, Callable, Optional

from .evaluation import Results, Section, Step, Work, skipped
from .figures import Figure, FigureImage, error_of, figure_steps, pictures_of
from .measures import MeasuredError, are_distinguishable, range_text, three_digits
from .report import Chapter, Table
from .scenes import (ASHIKHMIN_SHIRLEY, PAPER_TERMS, PAPER_THRESHOLD, PaperScene, Setup, default_options,
                     environment_light, paper_options, paper_recipe, paper_scenes, scene_recipe)

_MACHINE = "The paper's machine was a Pentium 4 of 2.6 GHz with a GeForce 5900."


def table_1(setup: Setup) -> Section:
    """What a bake takes: time and bytes."""
    title, scenes = "Table 1: bake time and size", paper_scenes(setup)
    if not scenes:
        return skipped(title, "there are no models")

    def step_name(scene: PaperScene, terms: int) -> str:
        return f"table-1-{scene.model.name}-k{terms}"

    def step_of(scene: PaperScene, terms: int) -> Step:
        recipe = paper_recipe(setup, scene, terms)

        def work(work: Work) -> Any:
            times = work.bakes.make_timed(recipe)
            path = work.bakes.make(recipe)
            total = work.program.json("info", path)["total"]
            numbers = {"vertices": total["vertices"], "ms_per_vertex": times["ms_per_vertex"],
                       "bytes_per_vertex": total["bytes_per_vertex"],
                       "stages": {name: stage["ms_per_vertex"] for name, stage in times["stages"].items()}}
            if terms == PAPER_TERMS[-1]:
                bases = path.with_suffix(".bases.relume")
                work.program.run("convert", path, "--layout", "bases", "-o", bases)
                numbers["bases_bytes_per_vertex"] = work.program.json("info", bases)["total"]["bytes_per_vertex"]
                bases.unlink()
            return numbers
        return Step(step_name(scene, terms), f"Table 1: {scene.input}, K = {terms}", None, work, [recipe])

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            "Bakes in the paper's way (relume bake --preset paper): Ashikhmin-Shirley on the object, white diffuse on "
            "the ground (one term), the paper's factorization, maps of 48 x 48, visibility drawn at 6 x 256² from a "
            "model simplified to 5000 triangles, the BRDF at every texel of it, rows of 96 coefficients. The "
            "paper simplifies to 11K, 20K, 32K and 17K, without a unit, of larger models; its models and ours differ "
            "in their numbers of vertices, so that times and bytes are compared by the vertex.")
        chapter.say(setup.scale.note)
        rows, stages, ours = [], [], []
        names = list(results[step_name(scenes[0], PAPER_TERMS[-1])]["stages"])
        for scene in scenes:
            model = scene.model
            for which, terms in enumerate(PAPER_TERMS):
                own = results[step_name(scene, terms)]
                paper_ms = model.minutes[which] * 60e3 / model.all_vertices
                paper_bytes = model.megabytes[which] * 1e6 / model.all_vertices
                bases = own.get("bases_bytes_per_vertex")
                ours.append((own["ms_per_vertex"], paper_ms / own["ms_per_vertex"],
                             own["bytes_per_vertex"] / paper_bytes, bases / paper_bytes if bases else None))
                rows.append([scene.input.name, f"{terms}", f"{own['vertices']}", f"{model.all_vertices}",
                             f"{own['ms_per_vertex']:.3g}", f"{paper_ms:.3g}", f"{model.minutes[which]}",
                             f"{ours[-1][1]:.0f}", f"{own['bytes_per_vertex']:.0f}", f"{paper_bytes:.0f}",
                             f"{model.megabytes[which]}", f"{bases:.0f}" if bases else "-"])
                stages.append([scene.input.name, f"{terms}",
                               *(f"{own['stages'][name]:.3f}" if name in own["stages"] else "-" for name in names)])
        chapter.items += [
            Table("table_1", "Bake time and size",
                  ["model with ground", "K", "vertices", "paper's vertices", "ms per vertex", "paper's ms per vertex",
                   "paper's minutes", "paper's time over ours", "bytes per vertex", "paper's bytes per vertex",
                   "paper's MB", "bytes per vertex in bases"], rows,
                  f"{_MACHINE} Bytes are of transport, in memory; a MB is 10⁶ of them. In bases: the same transport in "
                  "the layout that relume bake gives if not asked for another."),
            Table("table_1_stages", "Milliseconds of a vertex, by stages", ["model with ground", "K", *names], stages,
                  "As the device's clock has them, but for the host's own.")]
        ms, speed, bytes_of_rows, bases = zip(*ours)
        chapter.findings.append(
            f"Table 1: bakes in the paper's way take {range_text(ms)} ms a vertex; the paper reports "
            f"{range_text(speed)} times as much for its machine of 2004. Transport takes "
            f"{range_text(bytes_of_rows)} times the paper's bytes a vertex; in bases, "
            f"{range_text(share for share in bases if share)} times.")

    return Section(title, [step_of(scene, terms) for scene in scenes for terms in PAPER_TERMS], write)


_FRAMES = ((640, 480), (1280, 720))
_VARIANTS = (("k1", 0, "rows"), ("k4", 1, "rows"), ("k4-bases", 1, "bases"))  # name, which of PAPER_TERMS, layout


def table_2(setup: Setup) -> Section:
    """What a change of view and of light takes."""
    title, scenes = "Table 2: view and light changes", paper_scenes(setup)
    light = setup.inputs.environment("grace") or setup.inputs.any_environment()
    if not scenes or not light:
        return skipped(title, "there is no model or no environment")

    def step_name(scene: PaperScene) -> str:
        return f"table-2-{scene.model.name}"

    def step_of(scene: PaperScene) -> Step:
        recipes = [paper_recipe(setup, scene, terms) for terms in PAPER_TERMS]

        def work(work: Work) -> Any:
            files = [work.bakes.make(recipe) for recipe in recipes]
            bases = files[-1].with_suffix(".bases.relume")
            work.program.run("convert", files[-1], "--layout", "bases", "-o", bases)
            numbers = {}
            for width, height in _FRAMES:
                # As relume render --preset paper has it, for bases too.
                times = work.program.json(
                    "bench", "view", *files, bases, "-e", light.file, "--size", f"{width}x{height}", "--orbit=30,20,1",
                    "--threshold", PAPER_THRESHOLD, "--residual", "off", "--repeats", setup.scale.rounds)
                numbers[f"{width}x{height}"] = {name: {"view_ms": file["view_ms"], "light_ms": file["light_ms"]}
                                                for (name, _, _), file in zip(_VARIANTS, times["files"])}
            bases.unlink()
            return numbers
        return Step(step_name(scene), f"Table 2: {scene.input}", light.hash, work, recipes)

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            f"Wall-clock medians under {light}, turned by a degree from image to image, with the paper's light "
            "threshold of 1024, one sample a pixel and no residual. A view change draws the object anew; a light "
            "change samples, transforms and quantizes the light, relights every vertex in full, and shades; the camera "
            "stays, so that the triangles are not drawn again.")
        chapter.say(setup.scale.note)
        rows = []
        for scene in scenes:
            for width, height in _FRAMES:
                for name, which, layout in _VARIANTS:
                    times = results[step_name(scene)][f"{width}x{height}"][name]
                    view, lit = times["view_ms"], times["light_ms"]
                    rows.append([scene.input.name, f"{PAPER_TERMS[which]}", layout, f"{width} x {height}",
                                 *map(three_digits, (view, 1000 / view, scene.model.view_fps[which],
                                                     lit, 1000 / lit, scene.model.light_fps[which]))])
        chapter.items.append(Table(
            "table_2", "View and light changes",
            ["model", "K", "layout", "image", "view change, ms", "view change, fps", "paper's view change, fps",
             "light change, ms", "light change, fps", "paper's light change, fps"], rows,
            f"{_MACHINE} The size of its images is not known. Its bunny has 36,000 vertices, Buddha 56,000, dragon "
            "100,000 and Lucy 180,000; Table 1 has the numbers of ours."))

        width, height = _FRAMES[0]

        def against(variant: str) -> str:
            times = [(results[step_name(scene)][f"{width}x{height}"][variant], scene.model) for scene in scenes]
            view = range_text(1000 / own["view_ms"] / model.view_fps[1] for own, model in times)
            lit = range_text(1000 / own["light_ms"] / model.light_fps[1] for own, model in times)
            return f"{view} times the paper's changes of view a second and {lit} times those of light"
        chapter.findings.append(f"Table 2: at K = 4 and {width} x {height}, rows give {against('k4')}; bases "
                                f"{against('k4-bases')}. The paper's machine is of 2004, and its meshes differ.")

    return Section(title, [step_of(scene) for scene in scenes], write)


@dataclasses.dataclass
class _Way:
    """A way to keep transport: what it costs and gives."""
    title: str
    bytes: float  # a vertex
    light_ms: float
    view_ms: float
    error: MeasuredError


def layouts(setup: Setup) -> Section:
    """The paper's transport against the layouts and factorizations of now."""
    title, scenes = "Beyond the paper: equal bytes, equal time", paper_scenes(setup)
    light = setup.inputs.environment("grace") or setup.inputs.any_environment()
    if not scenes or not light:
        return skipped(title, "there is no model or no environment")
    scene = next((scene for scene in scenes if scene.model.name == "dragon"), scenes[0])
    scale, many = setup.scale, setup.scale.terms // 2
    budget = round(scene.model.megabytes[1] * 1e6 / scene.model.all_vertices)

    def image(name: str, what: str, options: dict[str, Any], threshold: Optional[int] = None) -> FigureImage:
        recipe = scene_recipe(setup, scene.model.name, scene.input, ASHIKHMIN_SHIRLEY, options)
        return FigureImage(name, what, recipe, threshold=threshold)
    figure = Figure("layouts", "Layouts", scale, environment_light(light), [
        image("paper", "the paper's: K = 4, rows", paper_options(4), PAPER_THRESHOLD),
        image("rows", "default factorization, K = 4, rows",
              default_options(terms=4, layout="rows", coefficients=96)),
        image("bases-4", "default, K = 4, bases", default_options(terms=4)),
        image("bases-many", f"default, K = {many}, bases", default_options(terms=many)),
        image("bases-budget", f"K = {many}, bases of {budget} bytes", default_options(terms=many, budget=budget)),
    ], azimuth=-20, elevation=15, distance=1.1)

    def time(work: Work) -> Any:
        times = work.program.json(
            "bench", "view", *(work.bakes.make(image.recipe) for image in figure.images), "-e", light.file, "--size",
            f"{scale.wide[0]}x{scale.wide[1]}", f"--orbit={figure.azimuth},{figure.elevation},{figure.distance}",
            "--repeats", scale.rounds)
        return {image.name: {"view_ms": file["view_ms"], "light_ms": file["light_ms"]}
                for image, file in zip(figure.images, times["files"])}
    times = Step("layouts-times", "Layouts: times", light.hash, time, [image.recipe for image in figure.images])

    def best(ways: list[_Way], cost: Callable[[_Way], float], what: str) -> str:
        """Among those that cost no more than the first, the paper's, but for a twentieth."""
        paper = ways[0]
        found = min((way for way in ways if cost(way) <= 1.05 * cost(paper)), key=lambda way: way.error.value)
        if found is paper or not are_distinguishable(found.error, paper.error):
            return f"Within the paper's {what}, none is distinguishably closer to the reference than its way."
        return (f"Within the paper's {what}, \"{found.title}\" is the closest to the reference: {found.error} instead "
                f"of {paper.error}, at {found.bytes:.0f} bytes a vertex instead of {paper.bytes:.0f} and "
                f"{found.light_ms:.1f} ms for a change of light instead of {paper.light_ms:.1f}.")

    def write(results: Results, chapter: Chapter) -> None:
        chapter.say(
            f"The {scene.input} in Ashikhmin-Shirley under {light}. The paper's way: its factorization, orthographic "
            "maps of 48 x 48, rows of 96 coefficients, drawn visibility of a simplified occluder. The default "
            "factorization is nonnegative, in equal-area maps, and what its terms leave is added; bases are the "
            "default layout. Errors are against the exact BRDF and the light's 6 x 256² texels.")
        chapter.say(scale.note)
        ways = [_Way(image.title, results[figure.step_of(image.name)]["bytes_per_vertex"],
                     **results[times.name][image.name], error=error_of(figure, results, image.name))
                for image in figure.images]
        chapter.items.append(Table(
            "layouts", "What ways to keep transport cost and give",
            ["way", "bytes per vertex", "light change, ms", "view change, ms", "RMSE (interval)"],
            [[way.title, f"{way.bytes:.0f}", f"{way.light_ms:.1f}", f"{way.view_ms:.1f}", str(way.error)]
             for way in ways],
            "A light change includes drawing; medians, all in alternation."))
        by_bytes = best(ways, lambda way: way.bytes, "bytes")
        chapter.say(by_bytes)
        chapter.findings.append(f"Layouts: {by_bytes}")
        chapter.say(best(ways, lambda way: way.light_ms, "time for a change of light"))
        chapter.items.append(pictures_of(figure, results, str(scene.input)))

    return Section(title, [*figure_steps(figure), times], write)
