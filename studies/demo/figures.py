"""The figures of the paper: lookup images, existing versus proposed, a light that changes color."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import skinglow as sg
from PIL import Image

from studies.figures import plt, save, to_screen
from studies.paths import IMAGES

BACKGROUND, INK = "#16181c", "#d8dade"
SHOWN_MM = 8.0
MELANIN = ("very_light", "light", "medium", "dark", "very_dark")
SKINS_MM, SKINS_EXPOSURE = 6.0, 8.0
plt.rcParams.update(
    {
        "figure.facecolor": BACKGROUND,
        "axes.facecolor": BACKGROUND,
        "savefig.facecolor": BACKGROUND,
        "text.color": INK,
        "axes.labelcolor": INK,
        "xtick.color": INK,
        "ytick.color": INK,
        "axes.edgecolor": INK,
        "font.size": 10,
    }
)


def draw_all(out: Path, numbers: dict[str, Any]) -> None:
    with np.load(out / "tables.npz") as file:
        tables = {name: file[name] for name in file.files}
    lookup_images(out / "lookups.png", tables, numbers)
    pictures(out / "existing_and_proposed.png", out, [("table1", "lights of Table 1")])
    pictures(out / "color_change.png", out, [("orange", "orange light"), ("blue", "blue light")])
    pictures(out / "rim.png", out, [("rim", "rim lights")])
    physical(out / "physical.png", out)
    skins(out / "skins.png")
    light_output(out / "light_output.png", out, 2.0 ** numbers["exposure_stops"])
    hosts(out / "blender_and_povray.png", out, numbers)


def to_docs(out: Path) -> None:
    """The pictures of README and docs that the demo makes."""
    Image.open(out / "hero.png").convert("RGB").save(IMAGES / "hero.jpg", quality=90)
    for name in ("color_change.png", "physical.png", "light_output.png"):
        shutil.copy(out / name, IMAGES)


def lookup_images(path: Path, tables: dict[str, np.ndarray], numbers: dict[str, Any]) -> None:
    """Each table as an image (scaled by its strength) and as curves over thickness."""
    names = {
        "table1_existing": "existing, any lights",
        "table1_paper": "lights of Table 1",
        "orange_paper": "orange light",
        "blue_paper": "blue light",
        "rim_paper": "rim lights",
    }
    figure, axes = plt.subplots(2, len(names), figsize=(14, 4.2), height_ratios=(1, 3), sharex=True)
    limit = numbers["max_thickness_mm"]
    for column, (name, title) in enumerate(names.items()):
        table = tables[name] * numbers["strength"]
        strip, curves = axes[:, column]
        strip.imshow(to_screen(table)[None], aspect="auto", extent=(0, limit, 0, 1), interpolation="bilinear")
        strip.set_yticks([])
        strip.set_title(title)
        thickness = np.linspace(0, limit, len(table))
        for channel, color in enumerate(("#ff6b5e", "#5fd36a", "#6aa2ff")):
            curves.semilogy(thickness, np.maximum(table[:, channel], 1e-12), color=color, label="RGB"[channel])
        curves.set_xlim(0, SHOWN_MM)
        curves.set_ylim(1e-4, 1e2)
        curves.set_xlabel("thickness, mm")
    axes[1, 0].set_ylabel("transmitted light, linear")
    axes[1, 0].legend()
    save(figure, path)


def pictures(path: Path, out: Path, rows: list[tuple[str, str]]) -> None:
    """One row per set of lights: existing and proposed, head and ear."""
    columns = [("existing", ""), ("existing", "_ear"), ("paper", ""), ("paper", "_ear")]
    figure, axes = plt.subplots(len(rows), 4, figsize=(16, 4.4 * len(rows)), squeeze=False)
    for row, (name, title) in zip(axes, rows, strict=True):
        for axis, (mode, view) in zip(row, columns, strict=True):
            axis.imshow(plt.imread(out / f"{name}_{mode}{view}.png"))
            axis.axis("off")
            if not view:
                axis.set_title(f"{'existing' if mode == 'existing' else 'proposed'}: {title}", loc="left")
    save(figure, path)


def skins(path: Path) -> None:
    """White light through skins, by thickness; one exposure for all."""
    light = sg.TISSUE_PRESETS["light"]
    fresh = light.replace(blood_fraction=0.03)
    groups = {
        "melanin": {name.replace("_", " "): sg.TISSUE_PRESETS[name] for name in MELANIN},
        "blood": {f"{100 * x:g} %": light.replace(blood_fraction=x) for x in (0.0, 0.005, 0.01, 0.03)},
        "oxygen in 3 %": {f"{100 * x:g} %": fresh.replace(oxygen_saturation=x) for x in (0.0, 0.5, 1.0)},
    }
    heights = [len(rows) for rows in groups.values()]
    figure, axes = plt.subplots(sum(heights), 1, figsize=(11, 0.42 * sum(heights) + 1.0), sharex=True)
    lines = iter(axes)
    for group, rows in groups.items():
        for row, (name, tissue) in enumerate(rows.items()):
            axis = next(lines)
            colors = np.maximum(sg.recolor(sg.base_lut(tissue, 256, SKINS_MM), (1.0, 1.0, 1.0)), 0.0) * SKINS_EXPOSURE
            colors /= np.maximum(1.0, colors.max(axis=1, keepdims=True))  # keep the hue of what is too bright
            axis.imshow(to_screen(colors)[None], aspect="auto", extent=(0.0, SKINS_MM, 0.0, 1.0))
            axis.set_yticks([])
            label = f"{group}: {name}" if row == 0 else name
            axis.set_ylabel(label, rotation=0, ha="right", va="center")
    axes[-1].set_xlabel("thickness, mm")
    save(figure, path)


def physical(path: Path, out: Path) -> None:
    """Mode physical: head and ear, lit per object and per pixel."""
    titles = {"object": "lit per object", "surface": "lit per pixel"}
    figure, axes = plt.subplots(1, 4, figsize=(16, 4.4))
    pictures_of = [(weights, view) for weights in titles for view in ("", "_ear")]
    for axis, (weights, view) in zip(axes, pictures_of, strict=True):
        axis.imshow(plt.imread(out / f"physical_{weights}{view}.png"))
        axis.axis("off")
        if not view:
            axis.set_title(f"physical: {titles[weights]}", loc="left")
    save(figure, path)


def light_output(path: Path, out: Path, exposure: float) -> None:
    """The picture, the light in it as an AOV, and the picture with that light in another color, by arithmetic alone."""
    with np.load(out / "light_output.npz") as file:
        picture, light = file["picture"], file["aov"]
    teal = light.max(axis=2, keepdims=True) * np.array((0.05, 0.75, 1.0))
    shown = {
        "the picture": picture,
        "Light of the Skinglow node as an AOV": light,
        "the picture - AOV + AOV in another color": picture - light + teal,
    }
    figure, axes = plt.subplots(1, 3, figsize=(13.2, 4.7))
    for axis, (title, linear) in zip(axes, shown.items(), strict=True):
        axis.imshow(to_screen(linear * exposure))
        axis.axis("off")
        axis.set_title(title, loc="left")
    save(figure, path)


def hosts(path: Path, out: Path, numbers: dict[str, Any]) -> None:
    """Both programs: the complete pictures (top), and the transmitted light with its difference (bottom)."""
    compared = numbers["comparison"]
    titles = {
        "table1_paper_ear.png": f"Blender {numbers['blender']} (Cycles)",
        "table1_povray.png": "POV-Ray 3.7: no indirect light, no specular",
        "": "",
        "light_through_blender.png": "Blender: transmitted light only",
        "light_through_povray.png": "POV-Ray: transmitted light, lookup by the macros",
        "difference.png": f"difference: RMS {compared['rms']:.1e}, white is {compared['heat_map_white']:.1e}",
    }
    figure, axes = plt.subplots(2, 3, figsize=(15, 10.3))
    for axis, (name, title) in zip(axes.flat, titles.items(), strict=True):
        if name:
            axis.imshow(plt.imread(out / name))
        axis.set_title(title)
        axis.axis("off")
    save(figure, path)
