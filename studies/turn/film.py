"""The light round the ear as a film: an image of all frames, which a page shows one by one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from studies.figures import to_screen

#: Of the light, off the front towards the ear's side: from behind the head to beside it.
AZIMUTHS = (190.0, 178.0, 166.0, 154.0, 140.0, 120.0)
FRAMES = len(AZIMUTHS)


def save_film(path: Path, rows: list[np.ndarray], exposure: float) -> None:
    """Rows of linear frames (n, height, width, 4), one above the other, frames side by side."""
    strips = [np.concatenate(list(to_screen(exposure * frames[:, :, :, :3])), axis=1) for frames in rows]
    Image.fromarray(np.uint8(np.round(255.0 * np.concatenate(strips, axis=0)))).save(path, quality=88)
