"""All reference values, and their table in docs/accuracy.md."""

from __future__ import annotations

import math
from pathlib import Path

from studies import report
from tests.references import hosts, lights, skin, surfaces, tables
from tests.references.reference import REFERENCES, Reference

__all__ = ["PAGE", "REFERENCES", "covered", "described", "table", "write_table"]

PAGE = Path(__file__).resolve().parents[2] / "docs" / "accuracy.md"
TOPICS = hosts, lights, skin, surfaces, tables


def covered() -> set[str]:
    """Public names that a reference tells of."""
    return {name.split(".")[0] for each in REFERENCES for name in each.functions}


def described(each: Reference) -> list[str]:
    """A row of the table but for the error that was found."""
    names = ", ".join(f"`{name}`" for name in each.functions)
    return [names, each.domain, each.source, f"{each.limit:g}"]


def rounded_up(error: float) -> str:
    """To one digit, so that compilers and processors that round otherwise print the same mostly."""
    if error == 0.0:
        return "0"
    digit = 10.0 ** math.floor(math.log10(error))
    return f"{math.ceil(error / digit) * digit:.0e}"


def table() -> str:
    rows = []
    for each in sorted(REFERENCES, key=lambda one: one.functions):
        names, domain, source, limit = described(each)
        rows.append([names, domain, source, rounded_up(each.measure()), limit])
    return report.table(["function", "domain", "reference", "largest error", "allowed"], rows)


def write_table() -> None:
    report.fill(PAGE, {"references": table()})
