"""Pictures of the lit ear by every method, exposed alike, and how Cycles' own picture differs from exitance / pi."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from studies import hosts
from studies.errors import Reference
from studies.figures import plt, save, to_screen
from studies.progress import Progress
from studies.shape.cases import HeadMesh

VIEWS = {"front": "from the front", "back": "from the light's side"}
#: Of the picture, over the ear's radius.
MARGIN = 1.0


@dataclass
class Pictures:
    """(height, width, 4) linear, by "view-method"."""

    images: dict[str, NDArray[np.float64]]
    seconds: dict[str, float]

    def of(self, view: str, method: str) -> NDArray[np.float64]:
        if method == "walk":
            return 0.5 * (self.images[f"{view}-walk_1"] + self.images[f"{view}-walk_2"])
        return self.images[f"{view}-{method}"]

    def exposed(self, view: str) -> NDArray[np.bool_]:
        """What the exposure is for: in the view from the front the skin in the dark, else all of it."""
        dark = self.images[f"{view}-dark"]
        return (dark[:, :, 3] > 0.999) & ((dark[:, :, 0] > 0.999) | (view != "front"))


@dataclass
class Stage:
    """What is rendered where. Pictures are kept in the folder `out` under `name`."""

    source: dict[str, Any]
    head: HeadMesh
    light: str
    out: Path
    name: str
    size: int
    host: hosts.Host
    progress: Progress

    def job(self) -> dict[str, Any]:
        light = self.head.light(self.light)
        radius_mm = float(np.linalg.norm(self.head.vertices[self.head.ear] - self.head.ear_center, axis=1).max())
        return {
            **self.source,
            "size": self.size,
            "out": str(self.out),
            "center": list(self.head.ear_center / 1000.0),
            "height": 2.0 * MARGIN * radius_mm / 1000.0,
            "light": {
                "kind": light.kind,
                "power": light.power,
                "radius": light.radius,
                "spot_angle": light.spot_angle,
                "spot_blend": light.spot_blend,
                "position": list(light.position),
                "direction": list(light.direction),
            },
        }

    def render(self, values: dict[str, NDArray[np.float64]], samples: int, part: str) -> Pictures:
        """Values by vertex (v, 3), shown as they are, and Cycles' walk where samples is not 0."""
        attributes, result = (self.out / f"{self.name}-{part}-{kind}.npz" for kind in ("attributes", "pictures"))
        np.savez(attributes, **values)
        job = {**self.job(), "attributes": str(attributes), "pictures": str(result), "samples": samples}
        seconds = self.host.run("studies.shape.picture_job", job, self.progress)["seconds"]
        with np.load(result) as file:
            return Pictures({name: file[name].astype(float) for name in file.files}, seconds)

    def walk(self, back_lit: NDArray[np.bool_], samples: int) -> Pictures:
        """Cycles' walk, and which pixels are back-lit skin ("dark"); rendered once."""
        kept, result = self.out / f"{self.name}-walk.json", self.out / f"{self.name}-walk-pictures.npz"
        about = {"samples": samples, "size": self.size}
        if kept.is_file() and (known := json.loads(kept.read_text()))["about"] == about:
            with np.load(result) as file:
                return Pictures({name: file[name].astype(float) for name in file.files}, known["seconds"])
        dark = np.zeros((len(self.head.vertices), 3))
        dark[self.head.ear[back_lit]] = 1.0
        found = self.render({"dark": dark}, samples, "walk")
        kept.write_text(json.dumps({"about": about, "seconds": found.seconds}))
        return found

    def pictures(self, exitance: dict[str, NDArray[np.float64]], back_lit: NDArray[np.bool_], samples: int) -> Pictures:
        """Exitance / pi by method, and Cycles' walk."""
        walk = self.walk(back_lit, samples)
        shown = self.render({name: values / np.pi for name, values in exitance.items()}, 0, "exitance")
        return Pictures({**walk.images, **shown.images}, walk.seconds)


def figure(path: Path, pictures: Pictures, methods: dict[str, str]) -> None:
    """Rows are views, columns methods; one exposure for a row."""
    rows, axes = plt.subplots(len(VIEWS), len(methods), figsize=(2.5 * len(methods), 2.6 * len(VIEWS) + 0.3))
    for index, (row, (view, title)) in enumerate(zip(axes, VIEWS.items(), strict=True)):
        exposure = 0.9 / np.percentile(pictures.of(view, "monte_carlo")[pictures.exposed(view)][:, 0], 97)
        for ax, (method, name) in zip(row, methods.items(), strict=True):
            ax.imshow(to_screen(exposure * pictures.of(view, method)[:, :, :3]), interpolation="nearest")
            ax.set_xticks([])
            ax.set_yticks([])
            if index == 0:
                ax.set_title(name, fontsize=10)
        row[0].set_ylabel(title, fontsize=10)
    save(rows, path)


@dataclass
class ViewDependence:
    """Cycles' picture over exitance / pi on the back-lit pixels of the view from the front."""

    pixels: int
    ratio: NDArray[np.float64]  # of the means, per channel
    rms: NDArray[np.float64]  # of the difference over the mean of exitance / pi, per channel, percent
    rms_at_best: NDArray[np.float64]  # the same with each channel at its best scale


def view_dependence(pictures: Pictures) -> ViewDependence:
    """Noise of both is taken out by their halves."""
    chosen = pictures.exposed("front")
    a, b, first, second = (
        pictures.images[f"front-{name}"][chosen][:, :3]
        for name in ("monte_carlo_a", "monte_carlo_b", "walk_1", "walk_2")
    )
    exitance, walk = 0.5 * (a + b), Reference(first, second).mean
    scale = (walk * exitance).mean(axis=0) / (a * b).mean(axis=0)

    def rms(factor: NDArray[np.float64] | float) -> NDArray[np.float64]:
        squares = ((factor * a - first) * (factor * b - second)).mean(axis=0)
        return 100.0 * np.sqrt(np.maximum(squares, 0.0)) / exitance.mean(axis=0)

    return ViewDependence(int(chosen.sum()), walk.mean(axis=0) / exitance.mean(axis=0), rms(1.0), rms(scale))
