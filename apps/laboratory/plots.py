"""Figures as SVG: curves over terms and bytes, lobes of BRDFs; and errors as heat."""

import dataclasses
from typing import Any, Optional, Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imsave
from matplotlib.ticker import NullFormatter

import relume

from .measures import luminance
from .store import Path, replacing

# Okabe and Ito's colors, which people with any color vision tell apart.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#888888"]
HEAT_RANGE = 0.5  # of the reference's mean luminance
_STYLE = {"svg.hashsalt": "relume", "svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9,
          "axes.titlesize": 9, "axes.grid": True, "grid.color": "#e4e4e4", "axes.edgecolor": "#888888"}


@dataclasses.dataclass
class Curve:
    label: str
    x: Sequence[float]
    y: Sequence[float]
    color: int
    dashed: bool = False


def curve_of_terms(label: str, values: Sequence[float], color: int, dashed: bool = False) -> Curve:
    """Of values after each of K terms."""
    return Curve(label, range(1, len(values) + 1), values, color, dashed)


@dataclasses.dataclass
class Panel:
    title: str
    curves: list[Curve]


def draw_lines(path: Path, title: str, x_label: str, y_label: str, panels: Sequence[Panel], columns: int = 4,
               ticks: Optional[Sequence[float]] = None, logarithmic_x: bool = False) -> None:
    """Panels that share their axes; y is logarithmic. A label that several panels have is listed once."""
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(max(5, 2.7 * columns), 1.3 + 2.1 * rows), layout="constrained")
        axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
        lines: dict[str, Any] = {}
        for axis, panel in zip(axes, panels):
            axis.set_title(panel.title)
            axis.set_yscale("log")
            if logarithmic_x:
                axis.set_xscale("log")
            if ticks is not None:
                axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
                axis.xaxis.set_minor_formatter(NullFormatter())
            for curve in panel.curves:
                lines[curve.label], = axis.plot(curve.x, curve.y, color=COLORS[curve.color % len(COLORS)],
                                                linestyle="--" if curve.dashed else "-", linewidth=1.4,
                                                marker="." if len(curve.x) < 8 else "")
        for axis in axes[len(panels):]:
            axis.set_visible(False)
        figure.suptitle(title, fontsize=11, fontweight="bold")
        figure.supxlabel(x_label)
        figure.supylabel(y_label)
        figure.legend(lines.values(), lines.keys(), loc="upper left", bbox_to_anchor=(1, 0.95), frameon=False)
        _save(figure, path)


def draw_lobes(path: Path, material: str, factors: dict[str, Any], title: str) -> None:
    """f cosθo (luminance) over the outgoing angle for four incoming angles, in the plane of the normal and s.

    Solid: the BRDF; dashed: its terms, whose negative values are drawn as 0.
    """
    angles = np.radians(np.linspace(-90, 90, 361))

    def directions(angle: np.ndarray) -> np.ndarray:
        return np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=-1).astype(np.float32)
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(9, 6), layout="constrained")
        for place, degrees in enumerate((0, 30, 60, 80)):
            axis = figure.add_subplot(2, 2, place + 1, projection="polar")
            axis.set_theta_zero_location("N")
            axis.set_theta_direction(-1)
            axis.set_thetalim(-np.pi / 2, np.pi / 2)
            incoming = directions(np.full_like(angles, -np.radians(degrees)))
            for of, style, label in ((material, "-", "BRDF"), (factors, "--", f"K = {len(factors['light_maps'])}")):
                values = np.maximum(luminance(relume.brdf_values(of, incoming, directions(angles))), 0)
                axis.plot(angles, values * np.cos(angles), style, color=COLORS[style == "--"], label=label)
            peak = axis.lines[0].get_ydata().max() or 1
            axis.set_ylim(0, 1.15 * peak)
            axis.set_yticks([peak / 2, peak], [f"{peak / 2:.3g}", f"{peak:.3g}"])
            axis.annotate("", xytext=(-np.radians(degrees), 1.15 * peak), xy=(-np.radians(degrees), 0.95 * peak),
                          arrowprops={"arrowstyle": "->", "color": "#444444"})
            axis.set_title(f"light at {degrees}°")
        axis.legend(loc="lower right", frameon=False)
        figure.suptitle(f"{title}\nf cos θo over the outgoing angle, in the plane of normal and s (sr⁻¹)", fontsize=10)
        _save(figure, path)


def write_heat(path: Path, image: np.ndarray, reference: np.ndarray) -> None:
    """How far an image is from a reference: black none, yellow HEAT_RANGE of the reference's mean luminance or more."""
    covered = np.asarray(reference)[..., 3] > 0
    mean = float(np.mean(luminance(reference)[covered])) if covered.any() else 1
    difference = luminance(np.abs(np.asarray(image) - np.asarray(reference))) / (HEAT_RANGE * max(mean, 1e-30))
    heat = matplotlib.colormaps["inferno"](np.clip(difference, 0, 1))
    heat[..., 3] = covered
    write_display(path, heat)


def write_display(path: Path, values: np.ndarray, scale: int = 1) -> None:
    """Display values (height, width, 3 or 4) as .png, every pixel `scale` pixels a side."""
    enlarged = np.repeat(np.repeat(np.clip(values, 0, 1), scale, axis=0), scale, axis=1)
    with replacing(path) as temporary:
        imsave(temporary, enlarged)


def _save(figure: Figure, path: Path) -> None:
    figure.savefig(path, format="svg", bbox_inches="tight", metadata={"Date": None, "Creator": None})
