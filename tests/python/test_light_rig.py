"""Light rigs from files, as Python gets them; what a file may hold is tested with the reader, in tests/rig_files."""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
import skinglow as sg

DATA = Path(__file__).parents[1] / "data"


def test_table_1() -> None:
    rig = sg.read_light_rig(DATA / "table1.json")
    assert rig.name == "Table 1" and rig.notes == []
    np.testing.assert_array_equal(rig.coefficients, (1.0, 0.0, 1.0))
    np.testing.assert_array_equal(rig.blood_weight, sg.PAPER_BLOOD_WEIGHT)
    assert [light.name for light in rig.lights] == ["Light1", "Light2", "Light3"]
    np.testing.assert_array_equal(rig.lights[0].color, np.array((255, 112, 69)) / 255)
    # Distances of the paper's table: 0.92357, 0.85231, 1.01292.
    found = [row["distance"] for row in sg.light_report(rig.lights, rig.point)]
    np.testing.assert_allclose(found, (0.92357, 0.85231, 1.01292), atol=5e-6)


def test_every_key_arrives() -> None:
    rig = sg.read_light_rig(str(DATA / "all_kinds.json"))
    assert {light.kind for light in rig.lights} == {"POINT", "SUN", "SPOT", "AREA"}
    (spot,) = [light for light in rig.lights if light.kind == "SPOT"]
    assert spot.spot_angle != sg.Light("SPOT").spot_angle


def test_studio_light_hangs_on_the_camera() -> None:
    front = sg.read_light_rig(DATA / "two_lamps.sl")
    assert front.name == "two_lamps" and {light.kind for light in front.lights} == {"SUN"}
    same = sg.read_light_rig(DATA / "two_lamps.sl", camera_rotation=(np.pi / 2, 0.0, 0.0))
    side = sg.read_light_rig(DATA / "two_lamps.sl", camera_rotation=(np.pi / 2, 0.0, np.pi / 2))
    for a, b, c in zip(front.lights, same.lights, side.lights, strict=True):
        np.testing.assert_allclose(a.direction, b.direction, atol=1e-15)
        # A quarter turn about Z takes x to y.
        np.testing.assert_allclose(c.direction, (-a.direction[1], a.direction[0], a.direction[2]), atol=1e-15)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('{"skinglow_rig": 1}', "lights"),
        ('{"skinglow_rig": 1, "lights": [{"kind": "POINT",\n "watts": 3}]}', "line 2"),
        ('{"skinglow_rig": 1, "lights": [{"kind": "SPOT", "spot_angle": 9}]}', "spot_angle"),
        ("[", "rig.json"),
    ],
)
def test_what_is_not_allowed_is_refused_by_name(text: str, told: str, tmp_path: Path) -> None:
    (tmp_path / "rig.json").write_text(text)
    with pytest.raises(ValueError, match=told):
        sg.read_light_rig(tmp_path / "rig.json")


def test_missing_file_and_a_camera_for_a_rig_file(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="none.json"):
        sg.read_light_rig(tmp_path / "none.json")
    with pytest.raises(ValueError, match="camera_rotation"):
        sg.read_light_rig(DATA / "table1.json", camera_rotation=(0.0, 0.0, 0.0))


@pytest.mark.skipif(sys.platform != "linux", reason="names are text elsewhere")
def test_a_name_that_is_no_text(tmp_path):
    """POSIX' names are bytes; Python's text has those that are no UTF-8 as surrogates."""
    text = os.fsdecode(bytes(tmp_path) + b"/caf\xe9")
    (tmp_path / f"{text}.sl").write_bytes((DATA / "two_lamps.sl").read_bytes())
    for path in (f"{text}.sl", os.fsencode(f"{text}.sl"), Path(f"{text}.sl")):
        assert os.fsencode(sg.read_light_rig(path).name) == b"caf\xe9"
    for name, turned in ((f"{text}.none", None), (f"{text}.json", (0.0, 0.0, 0.0))):
        with pytest.raises(ValueError, match=re.escape(name)):
            sg.read_light_rig(name, turned)
