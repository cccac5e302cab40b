"""Every public function is held against a reference: whoever makes a number drift, on any build, notices."""

from __future__ import annotations

import re

import pytest
import skinglow as sg

from tests.references.all import PAGE, REFERENCES, covered, described
from tests.references.reference import Reference

#: Constants, not functions.
CONSTANTS = {
    "D65_SPECTRUM",
    "LEGACY_AREA_POWER_FACTOR",
    "PAPER_BLOOD_WEIGHT",
    "SAMPLE_WAVELENGTHS_NM",
    "TISSUE_PARAMETERS",
    "TISSUE_PRESETS",
    "__version__",
}


@pytest.mark.parametrize("reference", REFERENCES, ids=lambda each: each.measure.__name__)
def test_error_is_within_what_is_allowed(reference: Reference) -> None:
    assert reference.measure() <= reference.limit


def test_every_public_function_has_a_reference() -> None:
    assert set(sg.__all__) - CONSTANTS - covered() == set()


def test_the_page_has_the_table_as_it_is() -> None:
    """`python -m tests.references table` writes it. The errors themselves differ by how a build rounds."""
    text = PAGE.read_text(encoding="utf-8")
    section = text.split("<!-- measured: references -->\n")[1].split("<!-- end -->")[0]
    rows = [re.split(r" \| ", line[2:-2]) for line in section.strip().splitlines()[2:]]
    expected = [described(each) for each in sorted(REFERENCES, key=lambda one: one.functions)]
    assert [[*row[:3], row[4]] for row in rows] == expected
    assert all(float(row[3]) <= 1.5 * float(row[4]) for row in rows)  # rounded up to one digit
