"""Values go to other processes and are copied: pickle, copy and deepcopy give what is equal."""

import copy
import pickle

import numpy as np
import pytest
import skinglow as sg

VALUES = {
    "point light": sg.Light("POINT", (0.1, 0.2, 3.0), (1.0, 2.0, 3.0), power=-4.0, name="Key", radius=0.5),
    "sun": sg.Light("SUN", direction=(0.0, 3.0, 0.1), sun_angle=0.1, visible=False),
    "spot": sg.Light("SPOT", radius=0.1, soft_falloff=False, spot_angle=0.3, spot_blend=0.4, spot_cosine=True),
    "area light": sg.Light("AREA", area_shape="DISK", size_x=2.0, size_y=3.0, tangent=(0.0, 1.0, 0.0), spread=1.0),
    "tissue": sg.Tissue(melanin_fraction=0.1, blood_fraction=0.02, cartilage_fraction=0.5),
    "preset": sg.TISSUE_PRESETS["ear"],
    "layer": sg.Layer(1.3, 0.1, 2.0, -0.5, np.inf),
}


def copies(value: object) -> list[object]:
    pickled = [pickle.loads(pickle.dumps(value, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
    return [*pickled, copy.copy(value), copy.deepcopy({"held": value})["held"]]


@pytest.mark.parametrize("name", VALUES)
def test_a_value_is_what_it_was(name: str) -> None:
    value = VALUES[name]
    for found in copies(value):
        assert type(found) is type(value)
        assert found == value
        assert not found != value
        for field in (field for field in dir(value) if not field.startswith("_")):
            if not callable(getattr(value, field)):
                np.testing.assert_array_equal(getattr(found, field), getattr(value, field), err_msg=field)


def test_tables_rigs_and_worlds_are_what_they_were() -> None:
    table = sg.base_lut(sg.Tissue(), 8, 5.0, tolerance=0.1)
    for found in copies(table):
        np.testing.assert_array_equal(found.matrices, table.matrices)
        assert found.texel_mapping == table.texel_mapping
    for found in copies(sg.PreparedRig([VALUES["sun"], VALUES["spot"]])):
        assert found.lights == [VALUES["sun"], VALUES["spot"]]
    sky = sg.Environment.from_image(np.arange(24.0).reshape(2, 4, 3))
    for found in copies(sky):
        np.testing.assert_array_equal(found.coefficients, sky.coefficients)
        np.testing.assert_array_equal(found.mean_irradiance_error, sky.mean_irradiance_error)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_what_is_no_value_is_refused_in_words(protocol: int) -> None:
    """In protocols 0 and 1 pybind11's base class ended the process."""
    shape = sg.Shape([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [[0, 1, 2]])
    for value in (
        sg.slab([sg.Layer()]),
        sg.AngularWeight([0.0, 1.0], [1.0, 1.0]),
        shape,
        shape.light([]),
        sg.Occluders([]),
    ):
        with pytest.raises(TypeError, match=r"skinglow\.\w+ is not pickled or copied: give what it is made of"):
            pickle.dumps(value, protocol)
    assert copy.copy(shape).parts == shape.parts


def test_lights_are_equal_where_all_that_makes_them_is() -> None:
    light = VALUES["point light"]
    same = sg.Light("POINT", (0.1, 0.2, 3.0), (1.0, 2.0, 3.0), power=-4.0, name="Key", radius=0.5)
    assert light == same
    assert hash(light) == hash(same)
    assert hash(sg.Light(power=0.0)) == hash(sg.Light(power=-0.0))
    assert light != sg.Light("POINT", (0.1, 0.2, 3.0), (1.0, 2.0, 3.0), power=-4.0, name="Key", radius=0.6)
    assert light != sg.Light("POINT", (0.1, 0.2, 3.0), (1.0, 2.0, 3.0), power=-4.0, name="Rim", radius=0.5)
    assert light != "POINT"
