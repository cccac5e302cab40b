"""Mode physical: M(d) E / pi, its sliders and presets; base lookups from images and skins."""

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender import skin_settings, tissue_presets

from inside.scenes import BLOOD, add_light, assert_shows, depsgraph, patch, weight

THIN = [0.0, 1.0, 2.0, 3.0]


def physical_table(tissue, lights, point=(0.0, 0.0, 0.0)):
    return sg.recolor(sg.base_lut(tissue, 256, 12.0), sg.object_irradiance(lights, point) / np.pi).astype(np.float32)


def check_radiance_of_a_point_light(_work):
    key = add_light(color=(1.0, 0.5, 0.25), energy=40.0, location=(0.0, 0.0, 2.0))
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    # E = P / (4 pi d^2), by hand.
    irradiance = np.array((1.0, 0.5, 0.25)) * 40.0 / (16.0 * np.pi)
    expected = sg.recolor(sg.base_lut(sg.TISSUE_PRESETS["light"], 256, 12.0), irradiance / np.pi)
    radius = key.data.shadow_soft_size
    assert radius < 0.3
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), expected, rtol=0.02)
    key.data.shadow_soft_size = 0.0
    assert_shows(obj, expected.astype(np.float32), ulps=4)
    key.data.energy = 80.0
    assert_shows(obj, (2.0 * expected).astype(np.float32), ulps=4)


def check_dark_without_lights(_work):
    """Unlike the paper's sum, physical skin does not glow in the dark."""
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="physical")
    assert not sb.lut(obj, depsgraph()).any()
    sb.make_skin(obj, thickness=THIN, mode="paper")
    assert sb.lut(obj, depsgraph()).any()


def check_sliders_and_presets(_work):
    add_light(energy=40.0, location=(0.0, 0.0, 2.0)).data.shadow_soft_size = 0.0
    light = sg.Light(power=40.0, position=(0.0, 0.0, 2.0))
    obj = patch()
    state = sb.make_skin(obj, thickness=THIN, mode="physical", preset="ear", melanin_fraction=0.1)
    assert state.mode == "PHYSICAL" and obj.skinglow.preset == "CUSTOM"
    ear = sg.TISSUE_PRESETS["ear"]
    parameters = {name: getattr(ear, name) for name in tissue_presets.TISSUE_SLIDERS}
    parameters["melanin_fraction"] = 0.1
    assert_shows(obj, physical_table(sg.Tissue(**parameters), [light]), ulps=4)
    obj.skinglow.blood_fraction = parameters["blood_fraction"] = 0.05
    assert_shows(obj, physical_table(sg.Tissue(**parameters), [light]), ulps=4)
    for name, tissue in sg.TISSUE_PRESETS.items():
        obj.skinglow.preset = name.upper()
        assert obj.skinglow.preset == name.upper()
        assert_shows(obj, physical_table(tissue, [light]), ulps=4)


def check_sliders_are_the_cores(_work):
    """Same names, defaults, ranges and presets as the core has."""
    properties = skin_settings.SkinSettings.bl_rna.properties
    assert set(tissue_presets.TISSUE_SLIDERS) == set(sg.TISSUE_PARAMETERS)
    for name, (default, least, most, *_) in sg.TISSUE_PARAMETERS.items():
        found = [properties[name].default, properties[name].hard_min, properties[name].hard_max]
        np.testing.assert_allclose(found, [default, least, most], rtol=1e-6)
    presets = {item.identifier.lower() for item in properties["preset"].enum_items} - {"custom"}
    assert presets == set(sg.TISSUE_PRESETS)


def check_base_from_an_image(_work):
    key = add_light(location=(0.0, 0.0, 2.0))
    gray = np.linspace(1.0, 0.0, 32, dtype=np.float32)
    image = bpy.data.images.new("Base", 32, 2, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.ones((2, 32, 4), np.float32)
    pixels[:, :, :3] = gray[None, :, None]
    image.pixels.foreach_set(pixels.ravel())
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper", base="image", base_image=image)
    expected = (gray.astype(float)[:, None] * (BLOOD + weight([key], (0, 0, 0)))).astype(np.float32)
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), expected, rtol=1e-6)

    # Bytes of an sRGB picture are decoded: 188 is half of the light.
    coded = bpy.data.images.new("Coded", 4, 1)
    coded.pixels.foreach_set(np.tile(np.float32([188 / 255] * 3 + [1.0]), 4))
    sb.make_skin(obj, thickness=THIN, mode="paper", base_image=coded)
    shown = sb.lut(obj, depsgraph())
    np.testing.assert_allclose(shown, np.tile(0.5029 * (BLOOD + weight([key], (0, 0, 0))), (4, 1)), rtol=1e-3)


def check_base_from_the_skin(_work):
    key = add_light(location=(0.0, 0.0, 2.0))
    obj = patch()
    sb.make_skin(obj, thickness=THIN, mode="paper", base="skin", preset="pale")
    table = sg.recolor(sg.base_lut(sg.TISSUE_PRESETS["pale"], 256, 12.0), (1.0, 1.0, 1.0))
    gray = np.maximum(table @ (0.2126, 0.7152, 0.0722), 0.0)
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), gray[:, None] * (BLOOD + weight([key], (0, 0, 0))), rtol=1e-6)
