"""Errors of images against sampled references, with the intervals that they are known within."""

import dataclasses
import math
from typing import Iterable, Sequence

import numpy as np

import relume


@dataclasses.dataclass(frozen=True)
class MeasuredError:
    """Root mean square over covered pixels and channels, relative to that of the truth.

    low, high: two standard errors of the squared error either way, of the reference's noise alone.
    """
    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """"4.41 % (4.38 to 4.44)", or "at most 0.3 %" where the interval reaches 0."""
        if self.low <= 0:
            return f"at most {_percent(self.high, self.high)} %"
        width = self.high - self.low
        return (f"{_percent(self.value, width)} % ({_percent(self.low, width)} to {_percent(self.high, width)})")


def _percent(value: float, width: float) -> str:
    """In as many digits as tell the ends of the interval apart, but no more than three behind the point."""
    digits = min(3, max(1, math.ceil(-math.log10(100 * width)))) if width > 0 else 3
    return f"{100 * value:.{digits}f}"


def measured_error(image: np.ndarray, halves: tuple[np.ndarray, np.ndarray]) -> MeasuredError:
    """The error of a linear image (height, width, 3 or 4) against the truth of which a reference's halves are samples.

    The halves A and B (height, width, 4; alpha 0 where nothing is) have independent noise, so that the mean of
    (A - image)(B - image) is that of squared errors, free of it. Half of |A - image|^2 - |B - image|^2 of a pixel has
    the variance of its product, were noise normally distributed.
    """
    covered = halves[0][..., 3] > 0
    a, b = (np.asarray(half, dtype=np.float64)[covered][:, :3] for half in halves)
    found = np.asarray(image, dtype=np.float64)[covered][:, :3]
    level = float(np.mean(a * b)) if a.size else 0
    if level <= 0:
        return MeasuredError(0, 0, 0)
    square = float(np.mean((a - found) * (b - found)))
    swing = 0.5 * (np.sum((a - found) ** 2, axis=1) - np.sum((b - found) ** 2, axis=1))
    noise = float(np.sqrt(np.sum(swing ** 2))) / a.size

    def root(value: float) -> float:
        return math.sqrt(max(value, 0) / level)
    return MeasuredError(root(square), root(square - 2 * noise), root(square + 2 * noise))


def noise_of(halves: tuple[np.ndarray, np.ndarray]) -> float:
    """The standard error of the mean of a reference's halves, relative to the truth."""
    covered = halves[0][..., 3] > 0
    a, b = (np.asarray(half, dtype=np.float64)[covered][:, :3] for half in halves)
    level = float(np.mean(a * b)) if a.size else 0
    return math.sqrt(float(np.mean((a - b) ** 2)) / level) / 2 if level > 0 else 0


def are_distinguishable(a: MeasuredError, b: MeasuredError) -> bool:
    """Whether the squared errors differ by more than two standard errors of their difference.

    Their noise is taken as if it were independent: of images held against one reference this asks for more than it
    takes.
    """
    reaches = (error.high ** 2 - error.value ** 2 for error in (a, b))
    return abs(a.value ** 2 - b.value ** 2) > math.hypot(*reaches)


def refine(reference: relume.SampledReference, images: Sequence[np.ndarray], noise: float, most: int) -> None:
    """Adds passes, at most so many in all, until the reference's noise is this share of the least error."""
    step = 16
    while reference.passes < most:
        reference.add_passes(min(step, most - reference.passes))
        halves = reference.halves()
        if noise_of(halves) <= noise * min(measured_error(image, halves).value for image in images):
            return


def luminance(image: np.ndarray) -> np.ndarray:
    return np.asarray(image)[..., :3] @ np.array([0.2126, 0.7152, 0.0722])


def exposure_of(image: np.ndarray) -> float:
    """Stops that show nine tenths of the covered pixels at or below a bright gray."""
    values = luminance(image)[np.asarray(image)[..., 3] > 0]
    tenth = float(np.quantile(values, 0.9)) if values.size else 0
    return math.log2(0.6 / tenth) if tenth > 0 else 0


def range_text(values: Iterable[float]) -> str:
    """"0.84 to 1.2" of the least and the largest in three digits, or one number where these are the same."""
    values = list(values)
    if not values:
        return "-"
    low, high = (three_digits(value) for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def three_digits(value: float) -> str:
    """Never 1.23e+03."""
    return f"{value:.0f}" if abs(value) >= 999.5 else f"{value:.3g}"
