"""The figures of docs/accuracy.md."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import skinglow as sg
from matplotlib.ticker import LogLocator, StrMethodFormatter

from studies.accuracy import task
from studies.accuracy.measurements import THREADS, Point, RedCurves, TablePoint
from studies.figures import COLORS, MARKS, plt, save, to_screen

plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3, "legend.fontsize": 9})


def _plain_times(axes: plt.Axes) -> None:
    """Labels 1, 2, 5, 10, ... instead of powers. Call last: drawing on log axes resets the labels."""
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))


def _error_against_time(axes: plt.Axes, series: dict[str, list[Point]], labeled: bool) -> None:
    for (name, points), color, mark in zip(series.items(), COLORS, MARKS, strict=False):
        shown = [p for p in points if p.error > 1e-13]
        axes.loglog([p.time_ms for p in shown], [p.error for p in shown], color=color, marker=mark, label=name)
        if labeled:
            for p in shown:
                axes.annotate(p.label, (p.time_ms, p.error), (5, 4), textcoords="offset points", fontsize=8)
    axes.set_xlabel("time, ms, one thread")
    axes.legend()


def solver(path: Path, series: dict[str, list[Point]]) -> None:
    """Streams: error against time."""
    figure, axes = plt.subplots(figsize=(7, 4.5))
    _error_against_time(axes, series, labeled=True)
    axes.set_ylabel(f"largest relative error where T > {task.MIN_TRANSMITTANCE:g}")
    axes.set_title("30 wavelengths x 256 thicknesses, by streams per hemisphere")
    _plain_times(axes)
    save(figure, path)


def table(path: Path, points: list[TablePoint]) -> None:
    """What a table costs by tolerance, on one thread and on two."""
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for i, threads in enumerate(THREADS):
        name = "one thread" if threads == 1 else f"{threads} threads"
        times, errors = [p.times_ms[i] for p in points], [p.error for p in points]
        axes.loglog(times, errors, color=COLORS[i], marker=MARKS[i], label=name)
        for p, time_ms in zip(points, times, strict=True):
            axes.annotate(f"{p.tolerance:g}", (time_ms, p.error), (5, 4), textcoords="offset points", fontsize=8)
    axes.set_xlabel("time, ms")
    axes.set_ylabel("error of the table (norm of the report)")
    axes.set_title("A table of 256 entries, 0 to 12 mm, light skin, by tolerance")
    axes.legend()
    _plain_times(axes)
    save(figure, path)


def estimate(path: Path, points: list[Point]) -> None:
    """Measured against estimated error on random skins."""
    figure, axes = plt.subplots(figsize=(5.5, 4.5))
    estimated = np.array([p.estimate for p in points])
    axes.loglog(estimated, [p.error for p in points], "o", color=COLORS[0], markersize=4)
    ends = np.array([estimated.min(), estimated.max()])
    axes.loglog(ends, ends, color=COLORS[4], label="measured = estimated")
    axes.set_xlabel("error that base_lut estimates")
    axes.set_ylabel("error measured")
    axes.set_title(f"{len(points)} random skins, tolerances and thicknesses")
    axes.legend()
    save(figure, path)


def methods(path: Path, panels: list[RedCurves]) -> None:
    """The methods' curves, red light."""
    figure, axes = plt.subplots(1, len(panels), figsize=(10, 4.5), sharey=True)
    styles = ("-", "--", "-.", ":")
    for panel, ax in zip(panels, axes, strict=True):
        for (name, curve), color, style in zip(panel.curves.items(), COLORS, styles, strict=False):
            width = 2.5 if name == "solved" else 1.8
            ax.semilogy(task.THICKNESS_MM, curve, style, color=color, linewidth=width, label=name)
        ax.set_xlabel("thickness of the skin, mm")
        ax.set_title(panel.tissue)
        ax.set_ylim(1e-5, 1.3)
    axes[0].set_ylabel("transmitted red of white light, linear")
    axes[0].legend()
    save(figure, path)


def presets(path: Path) -> None:
    """How each preset shows white light and three colored lights, by thickness; each row has its own exposure."""
    lights = {"white": (1, 1, 1), "red": (1, 0, 0), "green": (0, 1, 0), "blue": (0, 0, 1)}
    figure, axes = plt.subplots(len(sg.TISSUE_PRESETS), len(lights), figsize=(10, 6), sharex=True, squeeze=False)
    for row, (name, tissue) in enumerate(sg.TISSUE_PRESETS.items()):
        lut = sg.base_lut(tissue, 256, 6.0)
        for column, (light, rgb) in enumerate(lights.items()):
            # Exposed for a thickness of 1.5 mm, otherwise the thick end would be black everywhere.
            color = np.maximum(sg.recolor(lut, rgb), 0.0)
            color *= 0.6 / color[64].max()
            color /= np.maximum(1.0, color.max(axis=1, keepdims=True))  # keep the hue of overexposed colors
            encoded = to_screen(color)
            ax = axes[row, column]
            ax.imshow(encoded[None], extent=(0, 6, 0, 1), aspect="auto")
            ax.set_yticks([])
            ax.grid(False)
            if column == 0:
                ax.set_ylabel(name, rotation=0, ha="right", va="center")
            if row == 0:
                ax.set_title(f"{light} light")
            if row == len(sg.TISSUE_PRESETS) - 1:
                ax.set_xlabel("thickness, mm")
    save(figure, path)
