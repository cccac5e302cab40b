"""The scenes of povray_macros/verify: they pass, they can fail, and no macro is without one."""

import re

import numpy as np
import pytest
import skinglow as sg
from povray_runs import MACROS, PovrayError, render, run, write

SCENES = {path.stem: path.read_text() for path in (MACROS / "verify").glob("*.pov")}
#: Former names, which other tests know.
FORMER = {"Skinglow_Recolour"}
CALL = re.compile(r"\b(Skinglow_\w+)\(")


def macros() -> dict[str, set[str]]:
    """Each macro and function, and what it calls; "" is what the include itself does."""
    found: dict[str, set[str]] = {"": set()}
    name = ""
    for line in re.sub(r"//.*", "", sg.povray_macros()).splitlines():
        start = re.match(r"#macro (\w+)|#declare (\w+) = function", line)
        if start:
            name = start[1] or start[2]
            found[name] = set()
        found[name] |= set(CALL.findall(line)) - {name}
        if line in ("#end", "}"):
            name = ""
    return found


def test_no_macro_is_without_a_verification_scene():
    called = macros()
    assert len(called) > 60
    used = set(CALL.findall("".join(SCENES.values())))
    head = (MACROS / "skinglow.inc").read_text().partition("#ifndef")[0]
    public = set(CALL.findall("".join(re.findall(r"^// (?:\w+ +| {6,})Skinglow_.*", head, re.M)))) - {"Skinglow_Blood"}
    assert len(public) >= 25
    assert public <= used, f"not in any scene of povray_macros/verify: {sorted(public - used)}"
    reached, found = set(), {""} | used & set(called)
    while found:
        reached |= found
        found = set().union(*(called[name] for name in found)) & set(called) - reached
    missing = set(called) - reached - FORMER
    assert not missing, f"not behind any scene of povray_macros/verify: {sorted(missing)}"


@pytest.mark.parametrize("scene", ["irradiance", "tables"])
def test_verification_scenes(tmp_path, scene):
    write(tmp_path, {"skinglow.inc": sg.povray_macros()})
    text = SCENES[scene]
    (tmp_path / "verify.pov").write_text(text)
    run(tmp_path, "verify.pov", "-F")
    first = re.search(r'\nVerify\w*\((".*)\)', text)
    wrong = text.replace(
        first[0], first[0].replace("100 / (16 * pi)", "100 / (16 * 3.14159)").replace(" 9,", " 9.001,"), 1
    )
    (tmp_path / "verify.pov").write_text(wrong)
    with pytest.raises(PovrayError, match=", should be|red should be"):
        run(tmp_path, "verify.pov", "-F")


@pytest.mark.parametrize("over", [0, 1])
def test_picture_of_lights_has_no_seam(tmp_path, over):
    files = {"skinglow.inc": sg.povray_macros(), "scene.pov": SCENES["lights"]}
    write(tmp_path, files | {"scene.ini": "Input_File_Name=scene.pov\nWidth=160\nHeight=25\n"})
    shown = render(tmp_path, "-A", f"Declare=Over={over}")
    left, right = shown[:, 1:79], shown[:, 81:159][:, ::-1]  # the outer columns end with the floors
    assert np.ptp(left) > 0.2 and left.min() >= 0.09 * over
    # The spots' edge falls between pixels.
    np.testing.assert_allclose(left, right, atol=2e-4)


def test_picture_of_textures_has_no_seam(tmp_path):
    write(tmp_path, {"skinglow.inc": sg.povray_macros(), "scene.pov": SCENES["textures"]})
    run(tmp_path, "scene.pov", "+W8", "+H1", "-A", "+FE", "+Otextures.exr", "Declare=Ramp=1")
    write(tmp_path, {"scene.ini": "Input_File_Name=scene.pov\nWidth=160\nHeight=25\n"})
    shown = render(tmp_path, "-A")
    left, right = shown[:, 1:79], shown[:, 81:159][:, ::-1]  # the outer columns end with the bands
    for band in np.split(left, 5):
        assert band.max() > 0.2
    np.testing.assert_allclose(left, right, atol=5e-4)  # the picture has half floats
