"""Spectra whose arguments once had other names."""

from skinglow import _core
from skinglow._renamed import renamed_keywords

line_spectrum = renamed_keywords(centre_nm="center_nm")(_core.line_spectrum)
