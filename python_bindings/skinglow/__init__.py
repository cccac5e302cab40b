"""Skin that glows in the colour of your lights: recoloured lookup tables for thin, back-lit skin.

Data flows one way: lights -> light_weight -> recolour(base, B + L) -> a host's image.
mm, W, nm, radians and linear Rec.709 everywhere; arrays are numpy float64; bad input raises ValueError.
Importing this loads neither OpenImageIO nor Embree: Blender has libraries of its own.
"""

from skinglow._core import *  # noqa: F403  the compiled module lists its public names
from skinglow._core import __version__  # noqa: F401
from skinglow._thickness import thickness  # noqa: F401
