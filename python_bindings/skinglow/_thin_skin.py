"""Where light may come through a body: its thin parts."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._numbers import real_numbers
from skinglow._shape import Shape

__all__ = ["near_thin_skin"]

#: The clearest skin that light is taken to go through, 1/mm: in the red, skin1 of Jensen et al., "A practical model for
#: subsurface light transport", SIGGRAPH 2001, figure 5. Light falls by exp(-5) in 18 mm of it.
_ABSORPTION, _REDUCED_SCATTERING, _MAX_THICKNESS_MM = (0.032,) * 3, (0.74,) * 3, 18.0


def near_thin_skin(
    vertices: ArrayLike, triangles: ArrayLike, thickness_mm: ArrayLike, *, unit_mm: float = 1.0
) -> NDArray[np.bool_]:
    """At which vertices of a body of skin light may come through its shape: (n,).

    The thin parts of a Shape in which some skin is thin by the thickness that is given, with all about it that light
    goes on to: it falls into the thick floor of a fold from the thin wall beside it, and fades out around. On two heads
    with a light behind the ear, skin of up to 15 mm sends out but 63 and 80 % of the red light that comes through.

    vertices      (n, 3), finite, in units of unit_mm
    triangles     (m, 3), whole numbers from 0 to below n
    thickness_mm  (n,), as `thickness` gives it; infinite or NaN where it is not known
    unit_mm       length of one unit of the vertices, mm, above 0

    Raises ValueError naming the argument, the value and what is allowed.
    """
    thickness = real_numbers("thickness_mm", thickness_mm)
    points = real_numbers("vertices", vertices)
    count = len(points) if points.ndim else 0
    if thickness.shape != (count,):
        raise ValueError(f"thickness_mm has shape {thickness.shape}; allowed: ({count},), one per vertex")
    shape = Shape(points, triangles, absorption=_ABSORPTION, reduced_scattering=_REDUCED_SCATTERING, unit_mm=unit_mm)
    thin = thickness <= _MAX_THICKNESS_MM
    near = np.zeros(count, bool)
    for part in shape.parts:
        if thin[part.points].any():
            near[part.points] = True
    return near
