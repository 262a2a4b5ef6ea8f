"""The ways to factor a BRDF, compared: docs/factorization.md is made of what this prints and draws."""

import dataclasses
from typing import Any, Callable, Optional, Sequence

import numpy as np

import relume

from . import plots
from .report import csv_of, markdown_of
from .store import Path, file_hash, kept, locked, log, write_text

MATERIALS = {  # as `relume bake` takes them
    "Ashikhmin-Shirley (10, 100)": "ashikhmin-shirley",
    "clay": "clay",
    "skin": "skin",
    "red-plastic": "red-plastic",
    "brown-plastic": "brown-plastic",
    "Cook-Torrance 0.3": '{"model": "cook-torrance", "diffuse": 0, "f0": 0.5, "roughness": 0.3}',
    "Cook-Torrance 0.15": '{"model": "cook-torrance", "diffuse": 0.2, "f0": 0.05, "roughness": 0.15}',
    "gold": "gold",
    "brushed-steel": "brushed-steel",
    "satin": "satin",
    "porcelain": "porcelain",
    "pearl": "pearl",
}
# Members of the sets that are priced: unlike each other, each pair, each four and all eight.
SET_MEMBERS = {
    "clay": "clay",
    "gold": "gold",
    "red-plastic": "red-plastic",
    "Ashikhmin-Shirley (10, 100)": "ashikhmin-shirley",
    "skin": "skin",
    "brushed-steel": "brushed-steel",
    "porcelain": "porcelain",
    "car-paint-blue": "car-paint-blue",
}


@dataclasses.dataclass(frozen=True)
class Approach:
    """A way to factor a BRDF."""
    factorization: str
    mapping: str
    texels: str
    color: int  # of its curves
    note: str = ""

    def __str__(self) -> str:
        return f"{self.factorization}, {self.mapping}{self.note}"


APPROACHES = (  # later curves are drawn over earlier ones
    Approach("paper", "orthographic", "centers", 1),
    Approach("paper", "polar-sine", "centers", 4),
    Approach("cosine", "orthographic", "means", 5),
    Approach("environment", "orthographic", "means", 3),
    Approach("environment", "equal-area", "centers", 7, ", texel centers"),
    Approach("cosine", "equal-area", "means", 2),
    Approach("environment", "equal-area", "means", 0),
    Approach("nonnegative", "equal-area", "means", 6),
)
_PAPER, _CENTERS, _COSINE, _DEFAULT, _NONNEGATIVE = 0, 4, 5, 6, 7
_COUNTS = (4, 8, 16, 24, 32)  # of terms
_MAIN_TERMS = 16
_MOST_TERMS = 32


@dataclasses.dataclass
class Options:
    lights: dict[str, Path]  # by name
    sizes: Sequence[int] = (16, 32, 48, 64)
    orientations: int = 240  # of the light; a quarter of them for uniform views

    @property
    def main_size(self) -> int:
        """The size at which all approaches are compared."""
        return 48 if 48 in self.sizes else max(self.sizes)

    def key(self) -> Any:
        return [[file_hash(light) for light in self.lights.values()], self.sizes, self.orientations]

    def load(self) -> list[relume.Light]:
        return [relume.Light.environment(light) for light in self.lights.values()]


class Study:
    """The errors of a material by every approach: a curve of each factorization, after each of its terms."""

    def __init__(self, name: str, curves: list[dict[str, Any]]) -> None:
        self.name, self.curves = name, curves

    def error(self, approach: int, size: int, terms: int, measure: str, light: int = 0) -> Optional[float]:
        """Relative, of so many terms, or all where a BRDF has fewer; None where it was not measured.

        measure: rms of f cos cos; pixels, radiance as the pixels of a convex object show it; or uniform, of its views.
        """
        for curve in self.curves:
            if (curve["approach"], curve["size"]) == (approach, size) and curve["factored"] in (terms, _MOST_TERMS):
                if APPROACHES[approach].factorization == "nonnegative" and curve["factored"] != terms:
                    continue
                values = curve["rms"] if measure == "rms" else curve[measure][light]
                return values[min(terms, len(values)) - 1]
        return None


def measure(material: str, options: Options) -> list[dict[str, Any]]:
    """The curves of a material."""
    factors, curves = [], []
    for size in options.sizes:
        for number, approach in enumerate(APPROACHES):
            # Nonnegative terms are only good together: each number of them is a factorization of its own. It is slow.
            is_whole = approach.factorization == "nonnegative"
            if is_whole and size != options.main_size:
                continue
            for terms in _COUNTS if is_whole else (_MOST_TERMS,):
                factors.append(relume.brdf(material, terms, approach.factorization, size, approach.mapping,
                                           approach.texels))
                curves.append({"approach": number, "size": size, "factored": terms, "rms": factors[-1]["rms_relative"]})
    lights = options.load()
    pixels = relume.radiance_errors(material, factors, lights, options.orientations)
    uniform = relume.radiance_errors(material, factors, lights, max(options.orientations // 4, 1), uniform=True)
    for number, curve in enumerate(curves):
        curve["pixels"] = [light[number] for light in pixels]
        curve["uniform"] = [light[number] for light in uniform]
    return curves


def run(folder: Path, materials: dict[str, str], options: Options) -> str:
    """Writes factorization.csv and the figures. Returns the tables in Markdown."""
    with locked(folder):
        studies = []
        for name, material in materials.items():
            curves = kept(folder, f"factorization-{_file_name(name)}", ["factorization", material, options.key()],
                          lambda: measure(material, options))
            studies.append(Study(name, curves))
        write_text(folder / "factorization.csv", _csv_of(studies, options))
        _draw(folder, studies, options)
    return _summary(studies, options)


def _file_name(name: str) -> str:
    return "".join(letter.lower() if letter.isascii() and letter.isalnum() else "_" for letter in name)


def _csv_of(studies: Sequence[Study], options: Options) -> str:
    rows: list[Sequence[Any]] = [("material", "approach", "size", "factored_terms", "terms", "measure", "environment",
                                  "error")]
    for study in studies:
        for curve in study.curves:
            approach = APPROACHES[curve["approach"]]
            measured = [("rms", "", curve["rms"])]
            for number, light in enumerate(options.lights):
                measured += [(measure, light, curve[measure][number]) for measure in ("pixels", "uniform")]
            for measure, light, values in measured:
                first = len(values) - 1 if approach.factorization == "nonnegative" else 0
                rows += [(study.name, approach, curve["size"], curve["factored"], terms + 1, measure, light,
                          f"{values[terms]:.6g}") for terms in range(first, len(values))]
    return csv_of(rows)


def _draw(folder: Path, studies: Sequence[Study], options: Options) -> None:
    def curve(study: Study, approach: int, size: int, measure: str, light: int, **look: Any) -> plots.Curve:
        points = [(terms, error) for terms in range(1, _MOST_TERMS + 1)
                  if (error := study.error(approach, size, terms, measure, light)) is not None]
        return plots.Curve(x=[x for x, _ in points], y=[y for _, y in points], **look)

    def draw(name: str, title: str, y_label: str, curves: Callable[[Study], list[plots.Curve]]) -> None:
        plots.draw_lines(folder / f"factorization_{name}.svg", title, "terms K", y_label,
                         [plots.Panel(study.name, curves(study)) for study in studies], ticks=(0, 8, 16, 24, 32))
    draw("rms", "RMS of f cos θi cos θo, relative", "relative RMS", lambda study: [
        curve(study, approach, size, "rms", 0, color=color, dashed=approach == _PAPER,
              label=f"{'paper' if approach == _PAPER else 'default'}, S = {size}")
        for approach in (_PAPER, _DEFAULT) for color, size in enumerate(options.sizes)])
    for light, name in enumerate(options.lights):
        draw(_file_name(name), f"Error of reflected radiance under {name}, S = {options.main_size}",
             "relative RMS of radiance", lambda study: [
                 curve(study, number, options.main_size, "pixels", light, color=approach.color, label=str(approach),
                       dashed=approach.factorization == "paper" or number == _CENTERS)
                 for number, approach in enumerate(APPROACHES)])


def _mean(values: Sequence[Optional[float]]) -> str:
    known = [value for value in values if value is not None]
    return f"{np.mean(known):.3f}" if known else "–"


def _summary(studies: Sequence[Study], options: Options) -> str:
    size, lights = options.main_size, range(len(options.lights))

    def comparison(before: int, after: int) -> str:
        """What _MAIN_TERMS terms of two approaches miss, and the ratio: by material and light."""
        rows, ratios = [], []
        for study in studies:
            errors = [[study.error(approach, size, _MAIN_TERMS, "pixels", light) for approach in (before, after)]
                      for light in lights]
            ratios.append([b / a for a, b in errors])
            rows.append([study.name, *(f"{a:.3f} → {b:.3f} ({b / a:.2f})" for a, b in errors), _mean(ratios[-1])])
        means = np.mean(ratios, axis=1)
        rows.append(["mean of ratios", *(f"{ratio:.3f}" for ratio in np.mean(ratios, axis=0)),
                     f"{means.mean():.3f}, largest {means.max():.3f}"])
        return markdown_of(["material", *options.lights, "mean ratio"], rows)

    def means(columns: dict[str, tuple[int, int]], measure: str) -> str:
        """Over all materials and lights, by approach and (size, terms)."""
        return markdown_of(["approach", *columns], [
            [str(approach), *(_mean([study.error(number, size, terms, measure, light)
                                     for study in studies for light in lights]) for size, terms in columns.values())]
            for number, approach in enumerate(APPROACHES)])
    by_terms = {f"K = {terms}": (size, terms) for terms in _COUNTS}
    by_size = {f"S = {side}": (side, _MAIN_TERMS) for side in options.sizes}
    default = markdown_of(["material, environment", *by_terms], [
        [f"{study.name}, {name}", *(f"{study.error(_DEFAULT, size, terms, 'pixels', light):.3f}" for terms in _COUNTS)]
        for study in studies for light, name in enumerate(options.lights)])
    main, both = f"S = {size}", f"K = {_MAIN_TERMS}, S = {size}"
    sections = {
        f"Radiance, paper → default, {both}": comparison(_PAPER, _DEFAULT),
        f"Radiance, mean over materials and environments, {main}": means(by_terms, "pixels"),
        "The same with uniform views": means(by_terms, "uniform"),
        f"RMS, mean over materials, {main}": means(by_terms, "rms"),
        f"Radiance over S, mean over materials and environments, K = {_MAIN_TERMS}": means(by_size, "pixels"),
        "RMS over S, likewise": means(by_size, "rms"),
        f"Radiance of the default, {main}": default,
        f"Radiance, texel centers → means, {both}": comparison(_CENTERS, _DEFAULT),
        f"Radiance, cosine → nonnegative, equal-area, {both}": comparison(_COSINE, _NONNEGATIVE),
    }
    return "".join(f"## {title}\n\n{table}\n" for title, table in sections.items())


def price_sets(folder: Path, materials: dict[str, str], options: Options) -> str:
    """What it costs a material to share its light maps: a table in Markdown.

    Radiance error, mean over the lights, of every material alone and in sets of 2, 4, 8 … of its neighbors in the list.
    """
    approach, texts = APPROACHES[_DEFAULT], list(materials.values())
    members = [1 << power for power in range(len(texts).bit_length())]

    def errors() -> list[list[list[float]]]:
        """By material, number of members and _COUNTS."""
        factors = []  # by number of members, then material
        for count in members:
            sets = [relume.brdf(texts[first:first + count], _MOST_TERMS, approach.factorization, options.main_size,
                                approach.mapping, approach.texels) for first in range(0, len(texts), count)]
            factors.append([own for one in sets for own in one])
        result = []
        for number, material in enumerate(texts):
            found = relume.radiance_errors(material, [own[number] for own in factors], options.load(),
                                           options.orientations)
            result.append([[float(np.mean([light[which][:terms][-1] for light in found])) for terms in _COUNTS]
                           for which in range(len(members))])
        log("sets are priced")
        return result
    with locked(folder):
        found = np.array(kept(folder, "sets", ["sets", texts, options.key()], errors))
    ratios = np.mean(found / np.where(found[:, :1] > 0, found[:, :1], 1), axis=0)
    rows = [[name, *(" / ".join(f"{error:.3f}" for error in own[:, k]) for k in range(len(_COUNTS)))]
            for name, own in zip(materials, found)]
    rows.append(["mean of ratios to alone", *(" / ".join(f"{ratio:.2f}" for ratio in ratios[:, k])
                                              for k in range(len(_COUNTS)))])
    return markdown_of([" / ".join(["alone", *map(str, members[1:])]), *(f"K = {terms}" for terms in _COUNTS)], rows)


def draw_brdf(material: str, lights: dict[str, Path], terms: int, factorization: str, size: int, plot: Optional[Path],
              lobes: Optional[Path]) -> None:
    """The errors of one material over its terms, and its lobes, as SVG."""
    factors = relume.brdf(material, terms, factorization, size)
    title = f"{material if len(material) <= 50 else material[:50] + '…'}, factorization {factorization}"
    if plot:
        curves = {"RMS of f cos cos": factors["rms_relative"], "Frobenius residual": factors["frobenius"],
                  "radiance, expected": factors["expected"]}
        loaded = [relume.Light.environment(light) for light in lights.values()]
        errors = relume.radiance_errors(material, [factors], loaded)
        measured = {name: of_light[0] for name, of_light in zip(lights, errors)}
        panel = plots.Panel("", [plots.curve_of_terms(name, values, color, name in curves)
                                 for color, (name, values) in enumerate({**curves, **measured}.items())])
        plots.draw_lines(plot, title, "terms K", "relative error", [panel])
    if lobes:
        plots.draw_lobes(lobes, material, factors, title)
