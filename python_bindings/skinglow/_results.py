"""Types of the dictionaries that functions of the compiled module return, for type checkers."""

from __future__ import annotations

from typing import Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

LightKind = Literal["POINT", "SUN", "SPOT", "AREA"]


class DirectionalTransmittance(TypedDict):
    """Of directional_transmittance: one entry per direction."""

    mu: NDArray[np.float64]  #: cosine to the normal, outside; the first is 1
    weight: NDArray[np.float64]  #: of a quadrature over mu
    transmittance: NDArray[np.float64]  #: fraction of a beam's flux


class DroppedLights(TypedDict):
    """Lights that culling left out for one reason."""

    lights: list[int]  #: indices
    reason: Literal["off", "unreachable", "negligible"]
    bound: NDArray[np.float64]  #: (3,) upper bound of what they give at any point of the box, W/m^2


class CullingResult(TypedDict):
    """Of PreparedRig.cull."""

    kept: list[int]  #: indices, ascending
    dropped: list[DroppedLights]
    bound: NDArray[np.float64]  #: (3,) sum of theirs, at most the tolerance, W/m^2


class LightReportEntry(TypedDict):
    """Of light_report: one light."""

    index: int
    name: str
    kind: LightKind
    distance: float  #: to the light's center, scene unit; 0 for a sun
    axis_angle: float  #: from the light's axis to the point, radians; 0 for a point light and a sun
    normal_angle: float | None  #: from the normal to the light, radians; None without a normal
    weight: NDArray[np.float64]  #: (3,) irradiance, W/m^2
    share: float  #: of the luminance of all lights, 0 to 1
    state: Literal[
        "shines",
        "hidden",
        "zero power",
        "black",
        "no width",
        "occluded",
        "culled",
        "behind light",
        "outside cone",
        "behind",
        "too weak",
    ]
