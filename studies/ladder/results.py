"""What the pictures of one head say: errors of each rung against both references, and its time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from studies.errors import Error, Reference
from studies.ladder.cells import Cells

#: Rungs by what they are called in figures; walks are beside them.
RUNGS = {
    "fixed": "fixed table",
    "tinted": "tinted table",
    "object": "physical, per object",
    "pixel": "physical, per pixel",
    "shape 1.2": "through the shape, 1.2 mm",
    "shape 0.8": "through the shape, 0.8 mm",
    "shape 0.5": "through the shape, 0.5 mm",
    "eevee": "EEVEE's translucency",
}
#: These have no unit of light: their strength is chosen by eye.
BY_EYE = ("fixed", "tinted", "eevee")
#: Samples of random walks, beside those of the reference.
WALKS = (1, 4, 16, 64, 256, 1024)
RIG_NAMES = {
    "behind": "bulb behind",
    "beside": "spot beside",
    "soft_box": "soft box behind",
    "two_colors": "orange and blue",
}


class Step(NamedTuple):
    """A rung under a rig."""

    seconds: float  #: CPU seconds of a picture after a light was moved
    monte_carlo: Error
    monte_carlo_at_best: Error
    walk: Error
    walk_at_best: Error

    @property
    def least(self) -> float:
        return min(self.monte_carlo.rms, self.monte_carlo_at_best.rms)


def equal_samples(cells: Cells, rig: str, many: int) -> int:
    """Samples of the walk that takes as long as a moved light through the shape at .8 mm."""
    half, one = cells[f"{rig}|half {many} 1"].seconds, cells[f"{rig}|walk 1"].seconds
    return max(1, round(cells[f"{rig}|shape 0.8"].seconds / ((half - one) / (many // 2 - 1))))


@dataclass
class Results:
    head: str
    title: str
    cells: Cells
    rigs: list[str]
    samples: int  # of both halves of the walk together
    versions: tuple[str, str]  # of the Blenders of Cycles and EEVEE

    def __post_init__(self) -> None:
        self._read: dict[str, np.ndarray] = {}

    def picture(self, rig: str, what: str) -> np.ndarray:
        """(height, width, 4), linear."""
        name = f"{rig}|{what}"
        if name not in self._read:
            self._read[name] = self.cells[name].pixels
        return self._read[name]

    def seconds(self, rig: str, what: str) -> float:
        return self.cells[f"{rig}|{what}"].seconds

    def prepared(self, rung: str) -> float:
        """CPU seconds before the first picture of a rung, with all of the head's skin."""
        return self.cells[f"{self.rigs[0]}|{rung}"].prepared

    @cached_property
    def halves(self) -> tuple[str, str]:
        return f"half {self.samples} 1", f"half {self.samples} 2"

    def compared(self, rig: str) -> np.ndarray:
        """The pixels of back-lit skin of the ear alone."""
        dark = self.picture(rig, "dark")
        return (dark[:, :, 0] > 0.999) & (dark[:, :, 3] > 0.999)

    def of(self, rig: str, what: str) -> np.ndarray:
        """The compared pixels, (n, 3)."""
        return self.picture(rig, what)[self.compared(rig)][:, :3]

    def monte_carlo(self, rig: str) -> Reference:
        return Reference(self.of(rig, "mc 1"), self.of(rig, "mc 2"))

    def walk(self, rig: str) -> Reference:
        return Reference(*(self.of(rig, half) for half in self.halves))

    def step(self, rig: str, rung: str) -> Step:
        pixels, truth, walk = self.of(rig, rung), self.monte_carlo(rig), self.walk(rig)
        return Step(
            self.seconds(rig, rung),
            truth.error(pixels),
            truth.error_at_best(pixels),
            walk.error(pixels),
            walk.error_at_best(pixels),
        )

    @cached_property
    def steps(self) -> dict[tuple[str, str], Step]:
        return {(rig, rung): self.step(rig, rung) for rig in self.rigs for rung in RUNGS}

    def walk_errors(self, rig: str) -> list[tuple[int, float, float]]:
        """Samples, CPU seconds, and the walk's noise; that of the converged picture by its halves' difference."""
        samples = [n for n in WALKS if n < self.samples]
        found = [
            (n, self.seconds(rig, f"walk {n}"), self.walk(rig).error(self.of(rig, f"walk {n}")).rms) for n in samples
        ]
        both = self.walk(rig)
        seconds = sum(self.seconds(rig, half) for half in self.halves)
        return [*found, (self.samples, seconds, both.noise)]

    def mean(self, rung: str, value: str) -> float:
        """Over the rigs, root mean square of an error (by its name in Step) or the mean of the seconds."""
        found = [getattr(self.steps[rig, rung], value) for rig in self.rigs]
        if value == "seconds":
            return float(np.mean(found))
        return float(np.sqrt(np.mean([each.rms**2 for each in found])))
