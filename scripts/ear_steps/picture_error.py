"""How far a picture is from a random walk that is itself noisy: the noise of the walk is taken out by its two seeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass
class Error:
    """RMS over the ear's pixels and channels, over the mean of the reference."""

    rms: float
    standard_error: float


@dataclass
class Reference:
    """Two pictures of one thing with independent noise, each (n, 3): the ear's pixels."""

    first: np.ndarray
    second: np.ndarray

    @property
    def mean(self) -> np.ndarray:
        return 0.5 * (self.first + self.second)

    def error(self, picture: np.ndarray) -> Error:
        """Of a picture (n, 3).

        The mean of (picture - first) (picture - second) is the mean square error of the picture: the noise of the two
        seeds is independent and drops out of their product.
        """
        scale = self.mean.mean()
        squares = ((picture - self.first) * (picture - self.second)).mean(axis=1) / scale**2
        rms = float(np.sqrt(max(squares.mean(), 0.0)))
        spread = float(squares.std() / np.sqrt(len(squares)))
        return Error(rms, spread / (2.0 * rms) if rms > 0.0 else float("inf"))

    def error_at_best(self, picture: np.ndarray) -> Error:
        """Of a picture at the strength with which it comes nearest."""
        return self.error(self.best_factor(picture) * picture)

    def only(self, some: np.ndarray) -> Reference:
        """Of some of the pixels, (n,) bool."""
        return Reference(self.first[some], self.second[some])

    @property
    def noise(self) -> float:
        """What is left in the mean of the two seeds, as an error of the same kind."""
        return float(0.5 * np.sqrt(((self.first - self.second) ** 2).mean()) / self.mean.mean())

    def best_factor(self, picture: np.ndarray) -> float:
        """The one strength with which the picture comes nearest."""
        return float((picture * self.mean).sum() / (picture * picture).sum())


@dataclass
class WalkCost:
    """CPU seconds of a random walk: something once, then the same for each sample; its error falls as their root."""

    fixed: float
    each: float
    error_of_one: float  # the error with one sample a pixel

    def seconds_to(self, error: float) -> float:
        return self.fixed + self.each * self.samples_to(error)

    def samples_to(self, error: float) -> float:
        return max(1.0, (self.error_of_one / error) ** 2)


def walk_cost(samples: np.ndarray, seconds: np.ndarray, errors: np.ndarray) -> WalkCost:
    """From renders at several numbers of samples. The one with the most samples knows best how noisy they are."""
    each, fixed = np.polyfit(samples, seconds, 1, w=1.0 / seconds)
    return WalkCost(max(0.0, float(fixed)), float(each), float(errors[-1] * np.sqrt(samples[-1])))


def fitted_by_thickness(thickness_mm: np.ndarray, reference: Reference, step_mm: float = 0.25) -> np.ndarray:
    """The best that any table over thickness can show, (n, 3): at each thickness the mean of the reference itself."""
    bins = (thickness_mm / step_mm).astype(np.int64)
    _, index, count = np.unique(bins, return_inverse=True, return_counts=True)
    fitted = np.empty_like(reference.mean)
    for channel in range(3):
        fitted[:, channel] = (np.bincount(index, reference.mean[:, channel]) / count)[index]
    return fitted
