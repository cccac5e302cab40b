"""Error of a picture relative to a noisy random walk, whose noise is eliminated by means of two seeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass
class Error:
    """RMS over the ear's pixels and channels, relative to the mean of the reference."""

    rms: float
    standard_error: float


@dataclass
class Reference:
    """Two renders of the same scene with independent noise, each (n, 3): the ear's pixels."""

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
        """Error of a picture at the best strength."""
        return self.error(self.best_factor(picture) * picture)

    def only(self, some: np.ndarray) -> Reference:
        """Restricted to a mask of the pixels, (n,) bool."""
        return Reference(self.first[some], self.second[some])

    @property
    def noise(self) -> float:
        """Residual noise of the mean of both seeds, in the same unit."""
        return float(0.5 * np.sqrt(((self.first - self.second) ** 2).mean()) / self.mean.mean())

    def best_factor_to(self, other: Reference) -> float:
        """The factor that brings this reference, as a picture, nearest to another."""
        return float((self.mean * other.mean).sum() / (self.first * self.second).sum())

    def best_factor(self, picture: np.ndarray) -> float:
        """The strength that minimizes the error."""
        return float((picture * self.mean).sum() / (picture * picture).sum())


@dataclass
class WalkCost:
    """CPU seconds of a random walk: linear in the samples; its error falls with their square root."""

    fixed: float
    each: float
    error_of_one: float  # the error with one sample per pixel

    def seconds_to(self, error: float) -> float:
        return self.fixed + self.each * self.samples_to(error)

    def samples_to(self, error: float) -> float:
        return max(1.0, (self.error_of_one / error) ** 2)


def walk_cost(samples: np.ndarray, seconds: np.ndarray, errors: np.ndarray) -> WalkCost:
    """Fitted to renders with several sample counts; the error is taken from the largest."""
    each, fixed = np.polyfit(samples, seconds, 1, w=1.0 / seconds)
    return WalkCost(max(0.0, float(fixed)), float(each), float(errors[-1] * np.sqrt(samples[-1])))


def fitted_by_thickness(thickness_mm: np.ndarray, reference: Reference, step_mm: float = 0.25) -> np.ndarray:
    """The best possible result of a table over thickness, (n, 3): the mean of the reference at each thickness."""
    bins = (thickness_mm / step_mm).astype(np.int64)
    _, index, count = np.unique(bins, return_inverse=True, return_counts=True)
    fitted = np.empty_like(reference.mean)
    for channel in range(3):
        fitted[:, channel] = (np.bincount(index, reference.mean[:, channel]) / count)[index]
    return fitted
