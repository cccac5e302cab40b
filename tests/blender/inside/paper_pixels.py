"""The pixels of the lookup against Eq. 1 to 3, and what follows the lights and what does not."""

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb

from inside.scenes import add_light, assert_shows, depsgraph, paper_table, patch, table_1

THIN = [0.0, 1.0, 2.0, 3.0]


def check_table_1_by_hand(_work):
    """B + L from the paper's own figures, worked out with no code of ours."""
    table_1()
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    by_hand = np.array(
        [
            1.8 + 1.0 / (1 + 0.92357**2) + 15 / 255 / (1 + 0.85231**2) + 1.0 / (1 + 1.01292**2),
            0.5 + 112 / 255 / (1 + 0.92357**2) + 64 / 255 / (1 + 0.85231**2) + 1.0 / (1 + 1.01292**2),
            0.4 + 69 / 255 / (1 + 0.92357**2) + 1.0 / (1 + 0.85231**2) + 1.0 / (1 + 1.01292**2),
        ]
    )
    shown = sb.lut(obj, depsgraph())
    assert shown.shape == (256, 3) and shown.dtype == np.float32
    # Blender keeps colors and places in single precision: 6e-8 each.
    np.testing.assert_allclose(shown[0] / sg.six_gaussian_base().matrices[0, 0, 0], by_hand, rtol=2e-7)


def check_pixels_are_exact(_work):
    """Bit by bit: single precision of the table from the lights as Blender stores them."""
    objects = table_1()
    obj = patch()
    state = sb.make_skin(obj, thickness=THIN, mode="paper")
    assert state.point == (0.0, 0.0, 0.0)
    lights = [
        sg.Light(color=tuple(o.data.color), position=tuple(o.matrix_world.translation), name=o.name) for o in objects
    ]
    table = sg.recolor(sg.six_gaussian_base(256, 12.0), np.add((1.8, 0.5, 0.4), sg.light_weight(lights, (0, 0, 0))))
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), table.astype(np.float32))
    assert_shows(obj, paper_table(objects))


def check_paper_follows_existing_does_not(_work):
    red = add_light(color=(1.0, 0.0, 0.0))
    paper, existing = patch("Paper"), patch("Existing")
    sb.make_skin(paper, thickness=THIN, mode="paper")
    sb.make_skin(existing, thickness=THIN, mode="existing")
    fixed = sg.six_gaussian_lookup(256, 12.0).astype(np.float32)
    np.testing.assert_array_equal(sb.lut(existing, depsgraph()), fixed)
    for color in ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)):
        red.data.color = color
        assert_shows(paper, paper_table([red]))
        np.testing.assert_array_equal(sb.lut(existing, depsgraph()), fixed)


def check_each_edit_of_a_light(_work):
    key, rim = add_light("Key"), add_light("Rim", color=(0.2, 0.4, 1.0), location=(1.0, 2.0, 0.5))
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    assert_shows(obj, paper_table([key, rim]))
    key.data.color = (0.9, 0.1, 0.3)
    assert_shows(obj, paper_table([key, rim]))
    key.location = (3.0, -1.0, 0.25)
    assert_shows(obj, paper_table([key, rim]))
    key.data.energy = 0.0
    assert_shows(obj, paper_table([rim]))
    key.data.energy = 1e-3
    assert_shows(obj, paper_table([key, rim]))
    rim.data.type = "SUN"
    assert_shows(obj, paper_table([key, bpy.data.objects["Rim"]]))
    rim.hide_viewport = True
    assert_shows(obj, paper_table([key]))
    rim.hide_viewport = False
    rim.hide_set(True)
    assert_shows(obj, paper_table([key]))
    rim.hide_set(False)
    assert_shows(obj, paper_table([key, rim]))
    key.name = "Renamed"
    assert_shows(obj, paper_table([key, rim]))
    bpy.data.objects.remove(rim)
    assert_shows(obj, paper_table([key]))
    bpy.data.objects.remove(key)
    assert_shows(obj, paper_table([]))


def check_settings_of_the_formula(_work):
    key = add_light(location=(0.5, 0.75, 2.0))
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper", attenuation=(0.5, 0.25, 2.0), size=64, max_thickness_mm=8.0)
    assert_shows(obj, paper_table([key], size=64, thickest=8.0, coefficients=(0.5, 0.25, 2.0)))
    sb.make_skin(obj, thickness=THIN, mode="paper", attenuation=(1, 0, 1), size=700, reference_point=(0.5, 0.0, 0.25))
    assert_shows(obj, paper_table([key], point=(0.5, 0.0, 0.25), size=700, thickest=8.0))
    obj.skinglow.reference = "BOUNDS"
    obj.location = (0.25, 0.5, 0.0)
    assert_shows(obj, paper_table([key], point=(0.25, 0.5, 0.0), size=700, thickest=8.0))
    for size in (1, 65536):
        sb.make_skin(obj, thickness=THIN, mode="paper", size=size)
        assert_shows(obj, paper_table([key], point=(0.25, 0.5, 0.0), size=size, thickest=8.0))


def check_update_says_what_and_why(_work):
    key = add_light("Key")
    obj = patch()
    state = sb.make_skin(obj, thickness=THIN, mode="paper", live=False)
    assert state.mode == "PAPER" and state.thickness_mm == (0.0, 3.0)
    assert sb.update(depsgraph()) == []
    key.data.color = (1.0, 0.5, 0.0)
    (rebuilt,) = sb.update(depsgraph())
    assert rebuilt.skin == "Patch" and rebuilt.mode == "VIEWPORT" and rebuilt.why == "light 'Key': color"
    key.location.x = 1.0
    add_light("Fill")
    (rebuilt,) = sb.update(depsgraph())
    assert rebuilt.why == "light 'Fill' added; light 'Key': position", rebuilt.why
    assert sb.update(depsgraph()) == []
