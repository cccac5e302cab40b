"""What the pictures of one head say: errors of each rung against both references, and its time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from studies.errors import Error, Reference

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


@dataclass
class Results:
    head: str
    title: str
    files: list[Path]
    told: dict[str, Any]  #: by the jobs "cycles" and "eevee"
    rigs: list[str]

    @cached_property
    def pictures(self) -> dict[str, np.ndarray]:
        """(height, width, 4) linear, by "rig|what"."""
        found: dict[str, np.ndarray] = {}
        for path in self.files:
            with np.load(path) as file:
                found |= {name: file[name].astype(float) for name in file.files}
        return found

    @cached_property
    def seconds(self) -> dict[str, float]:
        return self.told["cycles"]["seconds"] | self.told["eevee"]["seconds"]

    @cached_property
    def walks(self) -> list[int]:
        """Samples of the walks, the halves of the reference among them."""
        counts = {int(n.split("walk ")[1]) for n in self.pictures if "|walk " in n}
        return sorted(counts)

    def compared(self, rig: str) -> np.ndarray:
        """The pixels of back-lit skin of the ear alone."""
        dark = self.pictures[f"{rig}|dark"]
        return (dark[:, :, 0] > 0.999) & (dark[:, :, 3] > 0.999)

    def of(self, rig: str, what: str) -> np.ndarray:
        """The compared pixels, (n, 3)."""
        return self.pictures[f"{rig}|{what}"][self.compared(rig)][:, :3]

    def monte_carlo(self, rig: str) -> Reference:
        return Reference(self.of(rig, "mc 1"), self.of(rig, "mc 2"))

    def walk(self, rig: str) -> Reference:
        return Reference(self.of(rig, "reference 1"), self.of(rig, "reference 2"))

    def equal_time(self, rig: str) -> tuple[str, int]:
        """The walk that takes as long as a moved light through the shape: its picture, and its samples."""
        name = next(name for name in self.pictures if name.startswith(f"{rig}|equal time"))
        return name, int(name.rsplit(" ", 1)[1])

    def step(self, rig: str, rung: str) -> Step:
        pixels, truth, walk = self.of(rig, rung), self.monte_carlo(rig), self.walk(rig)
        return Step(
            self.seconds[f"{rig}|{rung}"],
            truth.error(pixels),
            truth.error_at_best(pixels),
            walk.error(pixels),
            walk.error_at_best(pixels),
        )

    @cached_property
    def steps(self) -> dict[tuple[str, str], Step]:
        return {(rig, rung): self.step(rig, rung) for rig in self.rigs for rung in RUNGS}

    def walk_errors(self, rig: str) -> list[tuple[int, float, float]]:
        """Samples, CPU seconds, and the walk's own noise against its converged picture."""
        found = [
            (n, self.seconds[f"{rig}|walk {n}"], self.walk(rig).error(self.of(rig, f"walk {n}")).rms)
            for n in self.walks
        ]
        halves = self.walk(rig)
        each = float(np.sqrt(((halves.first - halves.second) ** 2).mean() / 2.0) / halves.mean.mean())
        return [*found, (self.samples, self.seconds[f"{rig}|reference 1"], each)]

    @property
    def samples(self) -> int:
        return self.told["cycles"]["samples"]

    def mean(self, rung: str, value: str) -> float:
        """Over the rigs, root mean square of an error (by its name in Step) or the mean of the seconds."""
        found = [getattr(self.steps[rig, rung], value) for rig in self.rigs]
        if value == "seconds":
            return float(np.mean(found))
        return float(np.sqrt(np.mean([each.rms**2 for each in found])))
