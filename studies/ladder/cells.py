"""What a head's jobs have rendered so far, each in a file of its own, so that an interrupted run goes on from there."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np


class Cell(NamedTuple):
    """A picture, (height, width, 4) linear, and CPU seconds: of it, and of what was made ready before all."""

    pixels: np.ndarray
    seconds: float
    prepared: float


class Cells:
    """A folder of cells by name: "RIG|WHAT"."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    @classmethod
    def of(cls, folder: Path, head: str, job: dict[str, Any]) -> Cells:
        """Other meshes, rigs, sizes or hosts have other folders: what is there was made with the same."""
        files = b"".join(Path(file).read_bytes() for file in (job["mesh_file"], *job["rigs"].values()))
        settings = {key: job[key] for key in ("center", "height", "size", "host")}
        key = hashlib.sha256(files + json.dumps(settings, sort_keys=True).encode()).hexdigest()[:12]
        return cls(folder / f"{head}-{key}")

    def path(self, name: str) -> Path:
        return self.folder / (name.replace("|", " - ") + ".npz")

    def __contains__(self, name: str) -> bool:
        return self.path(name).is_file()

    def __getitem__(self, name: str) -> Cell:
        with np.load(self.path(name)) as file:
            return Cell(file["pixels"].astype(float), float(file["seconds"]), float(file["prepared"]))

    def keep(self, name: str, pixels: np.ndarray, seconds: float, prepared: float = 0.0) -> None:
        partial = self.path(name).with_suffix(".part")
        with partial.open("wb") as file:
            np.savez_compressed(file, pixels=pixels.astype(np.float32), seconds=seconds, prepared=prepared)
        partial.replace(self.path(name))

    def forget(self, start: str) -> None:
        """Of all rigs what begins so: to be made anew."""
        for path in self.folder.glob(f"* - {start}*.npz"):
            path.unlink()
