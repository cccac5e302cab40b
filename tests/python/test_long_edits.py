"""The long walk through random edits: what its parts may not do."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "blender"))
from long_edits import GROWN_MB, PART, grown_too_much


def test_a_process_that_grows_by_a_body_an_edit_is_a_fault() -> None:
    assert grown_too_much([[300.0, 60], [320.0, 80], [407.0, 161]]) is None
    assert grown_too_much([[300.0, 60], [300.0 + 2.0 * PART, 61]]) == "the process grew by 400 MB"
    assert GROWN_MB < 2.0 * PART
