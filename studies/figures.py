"""What figures share: colors, marks, the screen's curve, and saving."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  after selecting the backend

__all__ = ["COLORS", "MARKS", "plt", "save", "to_screen"]

# Colors that color-blind readers can distinguish (M. Okabe, K. Ito, "Color Universal Design", 2008), and markers.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9", "#999999")
MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")


def to_screen(linear: np.ndarray) -> np.ndarray:
    """Linear Rec.709 to sRGB's curve (IEC 61966-2-1), clipped to 0 to 1."""
    light = np.clip(linear, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def save(figure: plt.Figure, path: Path, dpi: int = 110) -> None:
    figure.tight_layout()
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
