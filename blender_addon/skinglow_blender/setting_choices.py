# SPDX-License-Identifier: GPL-3.0-or-later
"""What the settings of a skin can be chosen from."""

#: Files store the numbers, and scripts use the identifiers.
MODES = (
    (
        "PHYSICAL",
        "Physical",
        "Layered skin, solved by radiative transfer and lit by the irradiance on its far side",
        "NONE",
        2,
    ),
    (
        "EXISTING",
        "Fixed",
        "Fixed reddish lookup that ignores the lights, for comparison (mode 'existing' in Python)",
        "NONE",
        0,
    ),
    (
        "PAPER",
        "Tinted (Kim et al.)",
        "Base lookup times blood weight plus attenuated light colors (Kim et al., Eq. 1 to 3), independent of the "
        "power of the lights, for comparison (mode 'paper' in Python)",
        "NONE",
        1,
    ),
)
#: Names of modes and lightings that `make_skin` accepts besides their identifiers.
ALIASES = {
    "mode": {"FIXED": "EXISTING", "TINTED": "PAPER"},
    "weights": {
        "PER_OBJECT": "OBJECT",
        "PER_PIXEL": "SURFACE",
        "AUTO": "SURFACE",
        "THROUGH_THE_SHAPE": "SHAPE",
    },
}
LIGHTINGS = (
    (
        "OBJECT",
        "Per Object",
        "One weight for the whole object: each light as if the far side faced it, at the reference point",
    ),
    (
        "SURFACE",
        "Per Pixel",
        "Compute the light on the far side at each pixel, with its angle: for lights that are close",
    ),
    (
        "SHAPE",
        "Through the Shape",
        "Solve the light in the flesh itself, with the shape of the mesh and its shadows: the most accurate",
    ),
)
BASES = (
    ("BUILTIN", "Built-in", "Brightness of the six-Gaussian skin profile (d'Eon and Luebke 2007)"),
    ("IMAGE", "Image", "Brightness of an image's columns, thin skin on the left, thick skin on the right"),
    ("SKIN", "Skin", "Brightness of the skin described by the sliders"),
)
REFERENCES = (
    ("BOUNDS", "Bounds", "Center of the bounding box of the evaluated mesh"),
    ("ORIGIN", "Origin", "Origin of the object"),
    ("POINT", "Point", "Custom point in world space"),
    ("OBJECT", "Object", "Origin of another object, or a bone of an armature: moves with it"),
)
