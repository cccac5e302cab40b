"""The reference of light in a shape: tests/shape/shape_monte_carlo, from arrays to arrays."""

from __future__ import annotations

import subprocess
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from studies.paths import PROJECT
from studies.progress import Progress, StudyError

BUILD = PROJECT / "build" / "reference"


def build(progress: Progress) -> Path:
    """The program, built if it has to be."""
    progress.say("building the Monte Carlo (minutes, the first time)")
    for command in (
        ["cmake", "--preset", "release", "-B", BUILD, "-DSKINGLOW_TESTS=ON"],
        ["cmake", "--build", BUILD, "--target", "shape_monte_carlo"],
    ):
        done = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True)
        progress.note(done.stdout + done.stderr)
        if done.returncode != 0:
            remedy = f"run scripts/setup --tests; the compiler's words are in {progress.log}"
            raise StudyError(f"the Monte Carlo could not be built: {remedy}")
    return BUILD / "tests" / "shape" / "shape_monte_carlo"


class Truth(NamedTuple):
    """Exitance by vertex and channel, twice, from photons that have nothing in common."""

    a: NDArray[np.float64]
    b: NDArray[np.float64]
    #: per channel: incident, entered, left, absorbed, lost; irradiance times mm^2
    flux: NDArray[np.float64]
    seconds: float

    @property
    def mean(self) -> NDArray[np.float64]:
        return 0.5 * (self.a + self.b)


def monte_carlo(
    program: Path,
    vertices_mm: ArrayLike,
    triangles: ArrayLike,
    irradiance: ArrayLike,
    absorption: ArrayLike,
    reduced_scattering: ArrayLike,
    *,
    photons: int,
    refractive_index: float = 1.0,
    surface: str = "rough",
    anisotropy: float = 0.0,
    targets: ArrayLike = (),
    seed: int = 1,
    threads: int = 0,
) -> Truth:
    """Exitance for an irradiance (v,) or (v, channels); photons are per channel, both halves together."""
    positions = np.ascontiguousarray(vertices_mm, "<f8")
    corners = np.ascontiguousarray(triangles, "<u4")
    mua, mus = np.atleast_1d(absorption, reduced_scattering)
    channels = len(mua)
    light = np.asarray(irradiance, float)
    per_channel = light.T if light.ndim == 2 else light
    light = np.ascontiguousarray(np.broadcast_to(per_channel, (channels, len(positions))), "<f8")
    wanted = np.ascontiguousarray(targets, "<u4")
    header = np.array([len(positions), len(corners), channels, len(wanted), photons, seed, threads], "<i8")
    rest = [np.full(channels, value) for value in (anisotropy, refractive_index, float(surface == "rough"))]
    media = np.stack([mua, mus / (1.0 - anisotropy), *rest], 1).astype("<f8")
    with tempfile.TemporaryDirectory() as folder:
        source, result = Path(folder, "in"), Path(folder, "out")
        source.write_bytes(b"".join(part.tobytes() for part in (header, media, positions, corners, light, wanted)))
        begin = time.monotonic()
        subprocess.run([program, source, result], check=True)
        seconds = time.monotonic() - begin
        rows = np.fromfile(result, "<f8").reshape(channels, 5 + 2 * len(positions))
    a, b = rows[:, 5:].reshape(channels, 2, -1).transpose(1, 2, 0)
    return Truth(a, b, rows[:, :5], seconds)
