"""The command of the studies: what it lists is there, and it says in words what is missing."""

import importlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from studies import __main__ as command
from studies.errors import Reference
from studies.progress import StudyError
from studies.report import fill

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", command.STUDIES)
def test_each_study_can_be_run(name):
    assert callable(importlib.import_module(f"studies.{name}.study").main)


def test_a_name_that_no_study_has_is_told_with_those_there_are():
    done = subprocess.run([sys.executable, "-m", "studies", "eras"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith("skinglow: no study is named eras; there are: demo, accuracy, ear")


def test_without_a_build_it_says_what_to_run(monkeypatch, tmp_path):
    monkeypatch.setattr(command, "CLI", tmp_path / "skinglow")
    with pytest.raises(StudyError, match="run scripts/setup and scripts/build first"):
        command.require("blender")


def test_a_picture_as_noisy_as_the_reference_has_its_own_strength():
    random = np.random.default_rng(4)
    truth = random.uniform(0.5, 1.5, (40000, 3))
    dim, bright = (
        Reference(*(scale * truth * (1.0 + 0.5 * random.standard_normal(truth.shape)) for _ in range(2)))
        for scale in (1.0, 3.0)
    )
    assert dim.best_factor_to(bright) == pytest.approx(3.0, rel=0.02)


def test_a_page_without_the_section_is_told(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("<!-- measured: here -->\nold\n<!-- end -->\n")
    fill(page, {"here": "new"})
    assert page.read_text() == "<!-- measured: here -->\nnew\n<!-- end -->\n"
    with pytest.raises(ValueError, match="measured: there"):
        fill(page, {"there": "new"})
