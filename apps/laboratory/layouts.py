"""What layouts of transport lose for what they cost: docs/layouts.md holds its tables and plots."""

import dataclasses
from typing import Any, Sequence

import numpy as np

import relume

from . import plots
from .program import Program
from .report import csv_of, markdown_of
from .store import LabError, Path, file_hash, kept, locked, write_text

_LAYOUTS = ("rows", "bases")
_TICKS = (50, 200, 800, 3200, 12800)  # bytes


@dataclasses.dataclass
class Options:
    lights: dict[str, Path]  # by name
    rows: Sequence[int] = (24, 48, 96, 192)  # N
    budgets: Sequence[float] = (50, 100, 200, 400, 800, 1600)  # bytes a vertex, of bases
    size: tuple[int, int] = (320, 240)  # of images
    exact_rows: int = 2000  # that the error of transport is measured over


def relative_error(found: Sequence[np.ndarray], exact: Sequence[np.ndarray]) -> float:
    """Relative L2 over all arrays."""
    lost = sum(float(np.sum((np.asarray(a, np.float64) - b) ** 2)) for a, b in zip(found, exact))
    everything = sum(float(np.sum(np.asarray(b, np.float64) ** 2)) for b in exact)
    return float(np.sqrt(lost / everything)) if everything > 0 else 0


def transport_error(asset: relume.Asset, exact: relume.Asset, terms: Sequence[int], count: int) -> float:
    """Of the coefficients of about `count` rows of all parts, against those of another bake of the same vertices."""
    rows = [len(exact.mesh(part).positions) * own for part, own in enumerate(terms)]
    step = max(1, sum(rows) // count)
    lost, everything, first = 0.0, 0.0, 0
    for part, own in enumerate(rows):
        chosen = np.arange(-first % step, own, step)
        first += own
        for some in np.array_split(chosen, -(-len(chosen) // 100)) if len(chosen) else []:
            a, b = (np.asarray(one.coefficients(part, some.tolist()), np.float64) for one in (asset, exact))
            lost += float(np.sum((a - b) ** 2))
            everything += float(np.sum(b ** 2))
    return float(np.sqrt(lost / everything)) if everything > 0 else 0


class BakeStudy:
    """One bake in rows against what it is converted to."""

    def __init__(self, folder: Path, name: str, path: Path, program: Program, options: Options) -> None:
        self.name, self._folder, self._path, self._program, self._options = name, folder, path, program, options
        info = program.json("info", path)
        for part in info["parts"]:
            if (layout := part["sets"][0]["layout"]) != "rows":
                raise LabError(f"{path}: expected a bake in rows, best of many coefficients, found {layout}")
        self._exact = relume.Asset.load(path)
        self.vertices = info["total"]["vertices"]
        self._terms = [part["sets"][0]["terms"] for part in info["parts"]]
        self.terms = self._terms[0]
        self._lights = [relume.Light.environment(light) for light in options.lights.values()]
        hashes = [file_hash(path), [file_hash(light) for light in options.lights.values()], options.size]
        self.source = self._kept("source", hashes, lambda: self._measure(path, "rows"))
        self.variants = [self._kept("rows-" + f"{count}", [hashes, count],
                                    lambda: self._converted("rows", "-N", count)) for count in options.rows]
        self.variants += [self._kept(f"{layout}-{budget:g}", [hashes, layout, budget],
                                     lambda: self._converted(layout, "--budget", budget))
                          for layout in _LAYOUTS[1:] for budget in options.budgets]

    def _kept(self, what: str, inputs: Any, work: Any) -> dict[str, Any]:
        return kept(self._folder, f"layouts-{self.name}-{what}", ["layouts", inputs, self._options.exact_rows], work)

    def _converted(self, layout: str, *options: Any) -> dict[str, Any]:
        path = self._folder / "converted.relume"
        self._program.run("convert", self._path, "--layout", layout, *options, "-o", path)
        try:
            return self._measure(path, layout)
        finally:
            path.unlink()

    def _measure(self, path: Path, layout: str) -> dict[str, Any]:
        """Bytes of transport a vertex, in memory and compressed in the file; and relative errors.

        Of its coefficients and, by light, of tuples under all of the light, both against the bake; and by light of an
        image against the exact one.
        """
        asset, total = relume.Asset.load(path), self._program.json("info", path)["total"]
        renderers = [relume.Renderer(one, self._options.size, samples=1) for one in (asset, self._exact)]
        for renderer in renderers:
            renderer.select_light(threshold=0)
        references = self._references()
        return {
            "layout": layout,
            "bytes": total["bytes_per_vertex"],
            "on_disk": total["stored_transport_bytes"] / total["vertices"],
            "transport_error": transport_error(asset, self._exact, self._terms, self._options.exact_rows),
            "relit_errors": [relative_error(*(renderer.relight(light) for renderer in renderers))
                             for light in self._lights],
            "image_errors": [relume.compare(renderers[0].render(light), reference)["relative_rmse"]
                             for light, reference in zip(self._lights, references)],
        }

    def _references(self) -> list[np.ndarray]:
        """Of the first variant that asks for them."""
        if not hasattr(self, "_images"):
            self._images = [relume.reference(self._exact, light, size=self._options.size, samples=1, rays=1)
                            for light in self._lights]
        return self._images


def run(folder: Path, bakes: dict[str, Path], options: Options, program: Program) -> str:
    """Writes layouts.csv and the figures. Returns a table of each bake in Markdown."""
    with locked(folder):
        studies = [BakeStudy(folder, name, path, program, options) for name, path in bakes.items()]
        rows: list[Sequence[Any]] = [("bake", "vertices", "terms", "layout", "bytes", "on_disk", "transport_error",
                                      "environment", "relit_error", "image_error")]
        for study in studies:
            for layout, own in [("source", study.source), *((own["layout"], own) for own in study.variants)]:
                rows += [(study.name, study.vertices, study.terms, layout, f"{own['bytes']:.6g}",
                          f"{own['on_disk']:.6g}", f"{own['transport_error']:.6g}", light, f"{relit:.6g}",
                          f"{image:.6g}")
                         for light, relit, image in zip(options.lights, own["relit_errors"], own["image_errors"])]
        write_text(folder / "layouts.csv", csv_of(rows))
        _draw(folder / "layouts_relit.svg", studies, options, "relit_errors", "Error of relit tuples")
        _draw(folder / "layouts_image.svg", studies, options, "image_errors", "Error of images against ray tracing")
    return "\n".join(_table_of(study, options) for study in studies)


def _draw(path: Path, studies: Sequence[BakeStudy], options: Options, errors: str, title: str) -> None:
    panels = []
    for study in studies:
        for number, light in enumerate(options.lights):
            curves = []
            for color, layout in enumerate(_LAYOUTS):
                points = sorted((own["bytes"], own[errors][number]) for own in study.variants
                                if own["layout"] == layout and _TICKS[0] <= own["bytes"] <= _TICKS[-1])
                curves.append(plots.Curve(layout, [x for x, _ in points], [y for _, y in points], color))
            panels.append(plots.Panel(f"{study.name}, {light}", curves))
    plots.draw_lines(path, title, "bytes of transport a vertex, in memory", "relative error", panels,
                     columns=len(options.lights), ticks=_TICKS, logarithmic_x=True)


def _table_of(study: BakeStudy, options: Options) -> str:
    columns = ["", "bytes", "on disk", "transport", *(f"{what}: {light}" for what in ("relit", "image")
                                                      for light in options.lights)]
    rows = [[name, f"{own['bytes']:.0f}", f"{own['on_disk']:.0f}",
             *(f"{error:.3f}" for error in [own["transport_error"], *own["relit_errors"], *own["image_errors"]])]
            for name, own in [("the bake", study.source), *((own["layout"], own) for own in study.variants)]]
    return f"{study.name}: {study.vertices} vertices, K = {study.terms}\n\n{markdown_of(columns, rows)}"
