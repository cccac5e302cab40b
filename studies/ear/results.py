"""Evaluates the pictures: errors, times, ratios by thickness."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from studies.errors import Error, Reference, WalkCost, fitted_by_thickness, walk_cost
from studies.medium import SKIN1

METHODS = {
    "existing": "existing (fixed lookup)",
    "paper": "paper (Eq. 1-3)",
    "object": "physical, per object",
    "surface": "physical, per pixel",
}
BIN_EDGES_MM = (0.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0, np.inf)
MIN_PIXELS = 20
THIN_MM = 8.0


@dataclass
class MethodResult:
    name: str
    seconds: float
    as_it_is: Error
    factor: float  # strength that minimizes the error
    at_best: Error
    brightness: float  # its mean over that of the walk
    thin: Error  # of skin up to THIN_MM only, at the best strength for it
    bounced: Error  # at its best strength, compared with walks with interreflection


@dataclass
class Limit:
    """The error of a hypothetical method that no mode implements."""

    name: str
    error: Error
    thin: Error  # of skin up to THIN_MM only


@dataclass
class Bin:
    low: float
    high: float
    pixels: int
    fraction_of_light: float  # of the walk
    fraction_of_error: float  # of the squared error per pixel at the best strength
    walk_over: dict[str, float]  # red of the walk over red of each method
    standard_error: float  # of the first


class Study:
    def __init__(self, folder: Path, numbers: dict[str, Any]) -> None:
        with np.load(folder / "pictures.npz") as file:
            self.pictures = {name: file[name] for name in file.files}
        self.numbers = numbers
        facts = self.pictures["ear_facts"]
        self.ear = (facts[:, :, 3] > 0.999) & (facts[:, :, 2] > 0.999)
        if self.ear.sum() < MIN_PIXELS:
            raise SystemExit(f"only {self.ear.sum()} pixels of the ear are back-lit; render a larger --size")
        self.thickness, self.view_cosine = facts[self.ear][:, 0], facts[self.ear][:, 1]
        self.reference = Reference(self.of("reference_1"), self.of("reference_2"))
        self.bounced = Reference(self.of("bounced_1"), self.of("bounced_2"))
        self.counts = sorted(int(n.removeprefix("walk_")) for n in self.pictures if n.startswith("walk_"))
        self.walk_errors = [self.reference.error(self.of(f"walk_{n}")) for n in self.counts]
        self.walk_seconds = [numbers["seconds"][f"walk_{n}"] for n in self.counts]
        self.cost: WalkCost = walk_cost(
            np.array(self.counts), np.array(self.walk_seconds), np.array([e.rms for e in self.walk_errors])
        )
        self.is_thin = self.thickness <= THIN_MM
        self.thin_reference = self.reference.only(self.is_thin)
        self.methods = [self._method(name) for name in METHODS]

    def of(self, name: str) -> np.ndarray:
        """The ear's pixels of a picture, (n, 3)."""
        return self.pictures[name][self.ear][:, :3]

    def _method(self, name: str) -> MethodResult:
        pixels = self.of(name)
        factor = self.reference.best_factor(pixels)
        return MethodResult(
            name=name,
            seconds=self.numbers["seconds"][name],
            as_it_is=self.reference.error(pixels),
            factor=factor,
            at_best=self.reference.error_at_best(pixels),
            brightness=float(pixels.mean() / self.reference.mean.mean()),
            thin=self.thin_reference.error_at_best(pixels[self.is_thin]),
            bounced=self.bounced.error_at_best(pixels),
        )

    def by_view(self) -> np.ndarray:
        """Per pixel, with the slab viewed at each pixel's angle, as Cycles' walk does on a plane slab."""
        order = np.linspace(0.05, 1.0, 20)
        depth = np.linspace(0.0, 12.0, 121)
        table = np.stack([SKIN1.transmittance(depth, float(mu)) for mu in order])  # (cosine, thickness, channel)
        row = np.clip((self.view_cosine - order[0]) / (order[1] - order[0]), 0.0, len(order) - 1.001)
        column = np.clip(self.thickness / (depth[1] - depth[0]), 0.0, len(depth) - 1.001)
        i, j = row.astype(int), column.astype(int)
        s, t = (row - i)[:, None], (column - j)[:, None]
        low = (1 - t) * table[i, j] + t * table[i, j + 1]
        high = (1 - t) * table[i + 1, j] + t * table[i + 1, j + 1]
        return ((1 - s) * low + s * high) * self.of("ear_far_side") / np.pi

    def limits(self) -> list[Limit]:
        """Hypothetical methods, each at its best strength like the modes."""
        pictures = {
            "per pixel, thickness to any far side, however dark": self.of("surface_open"),
            "per pixel, slab viewed at each pixel's angle": self.by_view(),
            "the best possible table over thickness, fitted to the walk": fitted_by_thickness(
                self.thickness, self.reference
            ),
        }
        return [
            Limit(
                name,
                self.reference.error_at_best(pixels),
                self.thin_reference.error_at_best(pixels[self.is_thin]),
            )
            for name, pixels in pictures.items()
        ]

    def bins(self) -> list[Bin]:
        """Red of the walk over red of the physical methods, by thickness."""
        red = self.reference.mean[:, 0]
        difference = self.reference.first[:, 0] - self.reference.second[:, 0]
        others = {"surface": self.of("surface")[:, 0], "view": self.by_view()[:, 0], "object": self.of("object")[:, 0]}
        best = self.reference.best_factor(self.of("surface")) * self.of("surface")
        squares = (best - self.reference.first) * (best - self.reference.second)
        rows = []
        for low, high in zip(BIN_EDGES_MM[:-1], BIN_EDGES_MM[1:], strict=True):
            here = (self.thickness >= low) & (self.thickness < high)
            if here.sum() < MIN_PIXELS:
                continue
            noise = 0.5 * float(np.sqrt((difference[here] ** 2).sum())) / float(red[here].sum())
            over = {name: float(red[here].sum() / values[here].sum()) for name, values in others.items()}
            light = float(self.reference.mean[here].sum() / self.reference.mean.sum())
            error = float(squares[here].sum() / squares.sum())
            rows.append(Bin(low, high, int(here.sum()), light, error, over, noise * over["surface"]))
        return rows
