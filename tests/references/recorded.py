"""Values that have no reference but themselves: recorded once, so that whoever changes them notices.

python -m tests.references record    records them anew, where a change is meant; say why in the commit
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from tests.references.reference import of_largest

FILE = Path(__file__).with_name("recorded.json")
#: Set by `record`: values are taken instead of compared.
recording: dict[str, Any] | None = None


def recorded(name: str, found: dict[str, Any]) -> float:
    """Largest difference of each array from the one recorded, relative to its largest value."""
    if recording is not None:
        recording[name] = {key: np.asarray(value, float).round(12).tolist() for key, value in found.items()}
        return 0.0
    kept = json.loads(FILE.read_text())[name]
    assert kept.keys() == found.keys()
    return max(of_largest(found[key], kept[key]) for key in kept)


def write(values: dict[str, Any]) -> None:
    FILE.write_text(json.dumps(values) + "\n")
