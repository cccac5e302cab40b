"""Names of the macros beside those of the user's own scene."""

import re

import pytest
import skinglow as sg
from povray_runs import exact, run, write

CODE = re.sub(r"//.*", "", sg.povray_macros())
LOCALS = set(re.findall(r"#local (\w+)", CODE))
PARAMETERS = {name for found in re.findall(r"#macro \w+\(([^)]*)\)", CODE) for name in re.findall(r"\w+", found)}
#: What a scene has of its own: `F` and `Axis` are functions of isosurfaces and macros in many of them.
THEIRS = {name.removeprefix("Sg_") for name in LOCALS | PARAMETERS if not name.startswith("Skinglow_")}
KINDS = {
    "function": "#declare {0} = function(x, y, z) {{ x + y }}",
    "macro": "#macro {0}(One, Two) (One + Two) #end",
    "number": "#declare {0} = 7.5;",
    "text": '#declare {0} = "text";',
    "pigment": "#declare {0} = pigment {{ rgb 1 }}",
}
SCENE = """#version 3.7;
{before}
#include "skinglow.inc"
{after}
global_settings {{ assumed_gamma 1.0 }}
Skinglow_Light("POINT", <1, .44, .27>, <.9, 0, -2>, -z, 100, Skinglow_Point_Shape(0, 1))
Skinglow_Light("SUN", <.06, .25, 1>, <0, 0, -9>, z, 3, Skinglow_Sun_Shape(0))
Skinglow_Light("SPOT", <.6, .25, 1>, <0, 0, -3>, z, 3, Skinglow_Spot_Shape(0.2, 0, 1, .2, 0))
Skinglow_Light("AREA", <.6, .25, 1>, <0, .1, -3>, z, 3, Skinglow_Rectangle_Shape(0.5, 0.25, x, 2))
Skinglow_Light("AREA", <.6, .25, 1>, <0, .1, -3>, z, 3, Skinglow_Ellipse_Shape(0.5, 0.25, x, pi))
#declare My_L = Skinglow_Listed_Weight(<0, 0, 0>, <1, 0, 1>);
#declare My_E = Skinglow_Listed_Irradiance(<0, 0, 0>);
#declare My_Paper = Skinglow_Recolor(Skinglow_Six_Gaussian_Base(32, 12), Skinglow_Blood, My_L)
#declare My_Fixed = Skinglow_Six_Gaussian(32, 12)
#declare My_Solved = Skinglow_Recolor_Columns(My_Fixed, My_Paper, My_Fixed, Skinglow_Diffuse_Radiance(My_E))
#declare My_Thickness = function(x, y, z) {{ 12 * x }}
sphere {{ 0, 1 texture {{ Skinglow_Over(texture {{ pigment {{ rgb .3 }} }}, Skinglow_Table_Pigment(My_Paper), 1) }} }}
sphere {{ 2 * x, 1 texture {{
    Skinglow_Skin(pigment {{ rgb .3 }}, 1, Skinglow_Thickness_Pigment(My_Solved, 12, My_Thickness, 0), .1) }} }}
camera {{ location -5 * z }}
#fopen Out "out.txt" write
#write (Out, Skinglow_Exact_Text(My_E.x), "\\n", Skinglow_Exact_Text(My_L.y), "\\n")
#write (Out, Skinglow_Exact_Text(My_Solved[9].z))
#fclose Out
"""


def answers(folder, *, before="", after=""):
    write(folder, {"skinglow.inc": sg.povray_macros(), "scene.pov": SCENE.format(before=before, after=after)})
    run(folder, "scene.pov", "-F", "+W4", "+H3")
    return [exact(word) for word in (folder / "out.txt").read_text().split()]


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_may_have_names_of_its_own(tmp_path, kind):
    assert {"F", "Axis", "Sum", "Distance", "I"} < THEIRS
    expected = answers(tmp_path)
    declared = "\n".join(KINDS[kind].format(name) for name in sorted(THEIRS))
    assert answers(tmp_path, before=declared) == expected
    assert answers(tmp_path, after=declared) == expected


def test_every_name_that_is_declared_has_a_prefix():
    declared = LOCALS | set(re.findall(r"#(?:declare|macro) (\w+)", CODE))
    assert not {name for name in declared if not name.startswith(("Skinglow_", "Sg_"))}


def test_included_from_a_macro_of_the_user(tmp_path):
    text = '#macro F()\n#include "skinglow.inc"\n#end\nF()\n'
    assert answers(tmp_path, before=text) == answers(tmp_path)
