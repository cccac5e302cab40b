"""`skinglow lut --mode physical`: the same table as the Python package makes, and what it refuses."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import skinglow as sg

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))
RIG = ROOT / "tests" / "data" / "table1.json"


def run(*arguments):
    return subprocess.run(
        [PROGRAM, "lut", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def made(path, *arguments):
    done = run(*arguments, "-o", path)
    assert done.returncode == 0, done.stderr
    return np.loadtxt(path, delimiter=",", comments="#", skiprows=count_heading(path)), done.stdout


def count_heading(path):
    lines = path.read_text().splitlines()
    return next(i for i, line in enumerate(lines) if not line.startswith("#")) + 1


def test_skin_alone_is_lit_by_white(tmp_path):
    table, text = made(tmp_path / "ear.csv", "--skin", "ear", "--size", 32, "--max-thickness", 6)
    lut = sg.base_lut(sg.TISSUE_PRESETS["ear"], 32, 6.0)
    np.testing.assert_allclose(table[:, 0], lut.thickness_mm, atol=1e-12)
    np.testing.assert_allclose(table[:, 1:], sg.recolor(lut, (1, 1, 1)), rtol=1e-12)
    assert "mode physical" in text and "error at most" in text


def test_lights_bring_their_irradiance(tmp_path):
    table, text = made(tmp_path / "rig.csv", RIG, "--mode", "physical", "--melanin", 0.2, "--size", 16)
    irradiance = [float(v) for v in text.split("E (")[1].split(")")[0].split(",")]
    assert all(value > 0 for value in irradiance)
    lut = sg.base_lut(sg.Tissue(melanin_fraction=0.2), 16)
    np.testing.assert_allclose(table[:, 1:], sg.recolor(lut, irradiance), rtol=1e-12)


def test_every_parameter_has_an_option_that_counts(tmp_path):
    options = {
        "melanin_fraction": ("--melanin", 0.2),
        "blood_fraction": ("--blood-fraction", 0.04),
        "oxygen_saturation": ("--oxygen", 0.4),
        "epidermal_thickness_mm": ("--epidermis", 0.1),
        "scattering_scale": ("--scattering", 1.5),
        "refractive_index": ("--index", 1.37),
        "cartilage_fraction": ("--cartilage", 0.5),
    }
    assert set(options) == set(sg.TISSUE_PARAMETERS)
    for name, (option, value) in options.items():
        table, _ = made(tmp_path / "one.csv", "--skin", "medium", option, value, "--size", 8)
        lut = sg.base_lut(sg.TISSUE_PRESETS["medium"].replace(**{name: value}), 8)
        np.testing.assert_allclose(table[:, 1:], sg.recolor(lut, (1, 1, 1)), rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--skin", "nose"], "allowed: very_light, light"),
        (["--skin", "ear", "--melanin", "0.7"], "melanin_fraction is 0.7; allowed: 0 to 0.5"),
        (["--mode", "paper", "--skin", "ear"], "belong to --mode physical"),
        (["--mode", "physical", "--base", "gray.png"], "leave out --base"),
        (["--mode", "physical", "--tolerance", "1"], "tolerance is 1"),
        (["--mode", "physical", "--point", "0", "0", "0"], "need a RIG file"),
    ],
)
def test_what_makes_no_sense_is_refused(tmp_path, arguments, message):
    done = run(*arguments, "-o", tmp_path / "no.csv")
    assert done.returncode == 2
    assert message in done.stderr
    assert not (tmp_path / "no.csv").exists()
