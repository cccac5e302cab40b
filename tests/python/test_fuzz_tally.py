"""The table of what the fuzz targets executed."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzz import tally

ROOT = Path(__file__).resolve().parents[2]


def test_every_target_is_described_and_on_the_page() -> None:
    targets = {folder.name for folder in tally.CORPUS.iterdir()}
    assert targets == tally.WHAT.keys()
    page = (ROOT / "docs" / "trust.md").read_text(encoding="utf-8")
    assert all(f"| `{target}` |" in page for target in targets)


def test_runs_add_up(tmp_path: Path) -> None:
    file = tmp_path / "tally.csv"
    file.write_text("slab,1000,10,500,passed\nslab,2000,5.5,600,failed\nshape,,3,,failed\n")
    shape, slab, total = tally.rows(file)
    assert slab[2:5] == ["3,000", "16", "600"]
    assert shape[2:5] == ["0", "3", "0"]
    assert total[2:4] == ["3,000", "18"]
    assert int(shape[5]) >= 2
    file.write_text("unknown,1,1,1,passed\n")
    with pytest.raises(ValueError, match="unknown"):
        tally.rows(file)
