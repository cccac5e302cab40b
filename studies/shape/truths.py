"""The reference of each case, computed once and kept in the output folder."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from studies.monte_carlo import monte_carlo
from studies.progress import Progress
from studies.shape.cases import DARK, LIGHT, SKIN1, Case, HeadMesh

CASES = (
    Case("scan", "behind", SKIN1),
    Case("scan", "beside", SKIN1),
    Case("scan", "behind", DARK, is_solved_fine=False),
    Case("scan", "behind", LIGHT, is_solved_fine=False),
    Case("scan", "behind", SKIN1, 1.4, "rough", is_solved_fine=False),
    Case("scan", "behind", SKIN1, 1.4, "smooth"),
    Case("makehuman", "behind", SKIN1),
    Case("makehuman", "beside", SKIN1),
)
#: Those whose pictures are shown.
SHOWN = ("scan-behind-skin1", "makehuman-behind-skin1")


@dataclass
class Lit:
    """A case with its light and the two halves of its reference, by vertex."""

    case: Case
    head: HeadMesh
    irradiance: NDArray[np.float64]
    a: NDArray[np.float64]
    b: NDArray[np.float64]

    @property
    def mean(self) -> NDArray[np.float64]:
        return 0.5 * (self.a + self.b)

    @property
    def noise(self) -> NDArray[np.float64]:
        """Of a back-lit vertex, in percent of the mean, per channel."""
        chosen = self.head.ear[self.head.back_lit(self.irradiance)]
        part = self.head.vertex_area[chosen, None] / self.head.vertex_area[chosen].sum()
        difference = (part * (self.a - self.b)[chosen] ** 2).sum(axis=0)
        return 50.0 * np.sqrt(difference) / (part * 0.5 * (self.a + self.b)[chosen]).sum(axis=0)


def truth(case: Case, head: HeadMesh, program: Path, folder: Path, photons: int, progress: Progress) -> Lit:
    irradiance = head.irradiance(case.light)
    path = folder / f"truth-{case.name}.npz"
    if path.is_file():
        with np.load(path) as file:
            if int(file["photons"]) == photons:
                return Lit(case, head, irradiance, file["a"].astype(float), file["b"].astype(float))
    progress.say(f"{case.name}: Monte Carlo of {photons:,} photons per channel")
    result = monte_carlo(
        program,
        head.vertices,
        head.triangles,
        irradiance,
        case.medium.absorption,
        case.medium.reduced_scattering,
        photons=photons,
        refractive_index=case.refractive_index,
        surface=case.surface,
        targets=head.ear,
    )
    progress.say(f"{case.name}: {result.seconds:.0f} s")
    np.savez_compressed(path, a=result.a.astype(np.float32), b=result.b.astype(np.float32), photons=photons)
    return Lit(case, head, irradiance, result.a, result.b)
