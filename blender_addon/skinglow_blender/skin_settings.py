# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a skin: a property group on every object, `obj.skinglow`.

Files store settings by property name: names must not change, labels may.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .errors import core

#: Files store the numbers, and scripts use the identifiers.
MODES = (
    (
        "PHYSICAL",
        "Physical",
        "Layered skin, solved by radiative transfer and lit by the irradiance on its far side",
        "NONE",
        2,
    ),
    (
        "EXISTING",
        "Fixed",
        "Fixed reddish lookup that ignores the lights, for comparison (mode 'existing' in Python)",
        "NONE",
        0,
    ),
    (
        "PAPER",
        "Tinted (Kim et al.)",
        "Base lookup times blood weight plus attenuated light colors (Kim et al., Eq. 1 to 3), independent of the "
        "power of the lights, for comparison (mode 'paper' in Python)",
        "NONE",
        1,
    ),
)
#: Names of modes and lightings that `make_skin` accepts besides their identifiers.
ALIASES = {
    "mode": {"FIXED": "EXISTING", "TINTED": "PAPER"},
    "weights": {
        "PER_OBJECT": "OBJECT",
        "PER_PIXEL": "SURFACE",
        "AUTO": "SURFACE",
        "THROUGH_THE_SHAPE": "SHAPE",
    },
}
LIGHTINGS = (
    (
        "OBJECT",
        "Per Object",
        "One weight for the whole object: each light as if the far side faced it, at the reference point",
    ),
    (
        "SURFACE",
        "Per Pixel",
        "Compute the light on the far side at each pixel, with its angle: for lights that are close",
    ),
    (
        "SHAPE",
        "Through the Shape",
        "Solve the light in the flesh itself, with the shape of the mesh and its shadows: the most accurate",
    ),
)
BASES = (
    ("BUILTIN", "Built-in", "Brightness of the six-Gaussian skin profile (d'Eon and Luebke 2007)"),
    ("IMAGE", "Image", "Brightness of an image's columns, thin skin on the left, thick skin on the right"),
    ("SKIN", "Skin", "Brightness of the skin described by the sliders"),
)
REFERENCES = (
    ("BOUNDS", "Bounds", "Center of the bounding box of the evaluated mesh"),
    ("ORIGIN", "Origin", "Origin of the object"),
    ("POINT", "Point", "Custom point in world space"),
    ("OBJECT", "Object", "Origin of another object, or a bone of an armature: moves with it"),
)


def _changed(settings: "SkinSettings", _context: bpy.types.Context) -> None:
    """Tags the object: Blender does not report changes of add-on properties to the handlers."""
    if settings.enabled:
        settings.id_data.update_tag(refresh={"OBJECT"})


#: The core's named skins (skinglow.TISSUE_PRESETS).
PRESETS = (
    ("CUSTOM", "Custom", "Current values of the sliders"),
    ("VERY_LIGHT", "Very Light", "Very little melanin"),
    ("LIGHT", "Light", "Light skin, like the head in the paper"),
    ("MEDIUM", "Medium", "Medium pigmentation"),
    ("DARK", "Dark", "Dark skin"),
    ("VERY_DARK", "Very Dark", "Very much melanin"),
    ("PALE", "Pale", "Light skin with little blood"),
    ("FLUSHED", "Flushed", "Light skin with much blood, rich in oxygen"),
    ("CYANOTIC", "Cyanotic", "Light skin with much blood, poor in oxygen"),
    ("EAR", "Ear", "Thin skin over cartilage"),
)
#: The parameters of skinglow.Tissue that are sliders here.
TISSUE_SLIDERS = (
    "melanin_fraction",
    "blood_fraction",
    "oxygen_saturation",
    "epidermal_thickness_mm",
    "scattering_scale",
    "refractive_index",
    "cartilage_fraction",
)


@lru_cache(maxsize=1)
def _tissues() -> dict[str, tuple[float, ...]]:
    """The sliders of each preset, in single precision as Blender stores them."""
    presets = core().TISSUE_PRESETS
    return {
        name: tuple(float(np.float32(getattr(presets[name.lower()], slider))) for slider in TISSUE_SLIDERS)
        for name, _label, _description in PRESETS[1:]
    }


def _preset_of_sliders(settings: "SkinSettings") -> int:
    """The preset is not stored: it is the one whose values the sliders show, also where they are keyed or driven."""
    shown = tuple(getattr(settings, slider) for slider in TISSUE_SLIDERS)
    return next((i for i, tissue in enumerate(_tissues().values(), 1) if tissue == shown), 0)


def _set_sliders(settings: "SkinSettings", number: int) -> None:
    if number > 0:
        for slider, value in zip(TISSUE_SLIDERS, _tissues()[PRESETS[number][0]], strict=True):
            setattr(settings, slider, value)


class SkinSettings(bpy.types.PropertyGroup):
    """The settings of one skin. `make_skin` accepts every property that is not hidden as a keyword."""

    enabled: BoolProperty(name="Skin", description="Let light shine through this object", options={"HIDDEN"})
    live: BoolProperty(
        name="Live",
        default=True,
        update=_changed,
        description="Update when the lights change; if disabled, only Update Now does",
    )
    mode: EnumProperty(
        name="Mode",
        items=MODES,
        default="PHYSICAL",
        update=_changed,
        description="How the transmitted light is computed",
    )
    weights: EnumProperty(
        name="Lighting",
        items=LIGHTINGS,
        default="OBJECT",
        update=_changed,
        description="Whether the lights are evaluated once per object, at each pixel, or solved in the flesh "
        "(Physical mode)",
    )
    cell_mm: FloatProperty(
        name="Cells",
        # The subtype whose unit is mm whatever the unit of the scene.
        subtype="DISTANCE_CAMERA",
        default=0.8,
        min=0.02,
        soft_min=0.3,
        soft_max=1.6,
        max=1000.0,
        precision=2,
        update=_changed,
        description="Edge of the cells that light is solved on (Through the Shape); 0.8 mm for work, 0.5 mm is final "
        "quality",
    )
    reentries: IntProperty(
        name="Reentries",
        default=2,
        min=0,
        max=8,
        update=_changed,
        description="How often light that leaves skin may fall on skin again and enter it (Through the Shape)",
    )
    strength: FloatProperty(
        name="Strength",
        default=1.0,
        min=0.0,
        soft_max=10.0,
        update=_changed,
        description="Factor on the transmitted light; 1 shows the lookup as computed",
    )
    base: EnumProperty(
        name="Base",
        items=BASES,
        default="BUILTIN",
        update=_changed,
        description="Base lookup: brightness by thickness",
    )
    base_image: PointerProperty(
        name="Image",
        type=bpy.types.Image,
        update=_changed,
        description="Base lookup; the rows of the image are averaged and color is reduced to brightness",
    )
    blood_weight: FloatVectorProperty(
        name="Blood Weight",
        subtype="COLOR",
        size=3,
        default=(1.8, 0.5, 0.4),
        min=0.0,
        soft_max=4.0,
        max=1e6,
        update=_changed,
        description="B of Eq. 1, added to the light weight; 1.8, 0.5, 0.4 in the paper",
    )
    attenuation: FloatVectorProperty(
        name="Attenuation",
        size=3,
        default=(1.0, 0.0, 1.0),
        min=0.0,
        soft_max=10.0,
        precision=3,
        update=_changed,
        description="Constant, linear and quadratic coefficients of Eq. 2, for distances in scene units",
    )
    preset: EnumProperty(
        name="Preset",
        items=PRESETS,
        get=_preset_of_sliders,
        set=_set_sliders,
        options=set(),
        description="Sets the sliders to those of a predefined skin. To animate the skin, key the sliders",
    )
    melanin_fraction: FloatProperty(
        name="Melanin",
        subtype="FACTOR",
        default=0.038,
        min=0.0,
        max=0.5,
        precision=3,
        update=_changed,
        description="Volume fraction of melanosomes in the epidermis",
    )
    blood_fraction: FloatProperty(
        name="Blood Volume",
        subtype="FACTOR",
        default=0.01,
        min=0.0,
        max=0.1,
        precision=4,
        update=_changed,
        description="Volume fraction of whole blood (150 g/L hemoglobin) in the dermis",
    )
    oxygen_saturation: FloatProperty(
        name="Oxygenation",
        subtype="FACTOR",
        default=0.75,
        min=0.0,
        max=1.0,
        update=_changed,
        description="Fraction of the hemoglobin that is oxygenated",
    )
    epidermal_thickness_mm: FloatProperty(
        name="Epidermis",
        # The subtype whose unit is mm whatever the unit of the scene.
        subtype="DISTANCE_CAMERA",
        default=0.06,
        min=0.0,
        max=0.3,
        precision=3,
        update=_changed,
        description="Thickness of each of the two epidermal layers, in mm",
    )
    scattering_scale: FloatProperty(
        name="Scattering",
        default=1.0,
        min=0.1,
        max=3.0,
        update=_changed,
        description="Factor on the scattering coefficient of every layer",
    )
    refractive_index: FloatProperty(
        name="IOR",
        default=1.4,
        min=1.0,
        max=1.6,
        update=_changed,
        description="Index of refraction of every layer, surrounded by air",
    )
    cartilage_fraction: FloatProperty(
        name="Cartilage",
        subtype="FACTOR",
        default=0.0,
        min=0.0,
        max=1.0,
        update=_changed,
        description="Volume fraction of cartilage in the inner layer",
    )
    reference: EnumProperty(
        name="Light Distance From",
        items=REFERENCES,
        default="BOUNDS",
        update=_changed,
        description="Point of the skin from which distances to the lights are measured",
    )
    reference_point: FloatVectorProperty(
        name="Point", subtype="TRANSLATION", size=3, update=_changed, description="Location in world space"
    )
    reference_object: PointerProperty(
        name="Object", type=bpy.types.Object, update=_changed, description="Object whose origin is the reference point"
    )
    reference_bone: StringProperty(
        name="Bone", update=_changed, description="Bone of that armature whose head is the reference point; empty: none"
    )
    size: IntProperty(
        name="Table Size",
        default=256,
        min=1,
        soft_max=1024,
        max=65536,
        update=_changed,
        description="Number of entries of the lookup",
    )
    max_thickness_mm: FloatProperty(
        name="Max Thickness",
        # The subtype whose unit is mm whatever the unit of the scene.
        subtype="DISTANCE_CAMERA",
        default=12.0,
        min=1e-3,
        soft_max=50.0,
        max=1e6,
        update=_changed,
        description="Thickness at the last entry of the lookup, in mm; thicker skin shows that entry",
    )
    unit_mm: FloatProperty(
        name="Unit",
        # The subtype whose unit is mm whatever the unit of the scene.
        subtype="DISTANCE_CAMERA",
        default=0.0,
        min=0.0,
        soft_max=1000.0,
        max=1e9,
        precision=3,
        update=_changed,
        description="Length of one Blender unit in mm; 0 uses the unit scale of the scene (1000 by default)",
    )
    rays: IntProperty(
        name="Rays",
        default=64,
        min=1,
        soft_max=512,
        max=65536,
        description="Number of rays per vertex for measuring the thickness",
    )
    min_openness: FloatProperty(
        name="Min Sky Visibility",
        subtype="FACTOR",
        default=0.1,
        min=0.0,
        max=1.0,
        description="Minimum fraction of the sky that a far side must see to let light in, so that the mouth and eye "
        "sockets stay dark; 0 accepts all far sides",
    )
    thickness_image: PointerProperty(
        name="Image",
        type=bpy.types.Image,
        options={"HIDDEN"},
        description="Thickness in the UV map of the mesh: mm, or fractions of the thickness of white",
    )
    group: PointerProperty(type=bpy.types.ShaderNodeTree, options={"HIDDEN"})
    row: IntProperty(default=-1, options={"HIDDEN"})


class LutImages(bpy.types.PropertyGroup):
    """The images of a skin node group, stored on each of them (image_pairs.py explains why there are four).

    Not stored on the node group: Blender miscounts the users of data that a node tree's properties point to.
    """

    viewport_a: PointerProperty(type=bpy.types.Image)
    viewport_b: PointerProperty(type=bpy.types.Image)
    render_a: PointerProperty(type=bpy.types.Image)
    render_b: PointerProperty(type=bpy.types.Image)


# A library's skin can be overridden in the file that uses it, and keeps what was set there.
OVERRIDE = {"LIBRARY_OVERRIDABLE"}
for _property in SkinSettings.__annotations__.values():
    _property.keywords["override"] = OVERRIDE

#: What `make_skin` does not accept, and all that it does.
NO_SETTINGS = ("enabled", "thickness_image", "group", "row")
SETTING_NAMES = tuple(name for name in SkinSettings.__annotations__ if name not in NO_SETTINGS)


#: Of these: how thickness is measured.
MEASURING_NAMES = ("unit_mm", "rays", "min_openness")


@contextmanager
def applied(settings: SkinSettings, values: dict[str, Any]) -> Iterator[None]:
    """Context manager that sets properties by name, and sets all of them back if anything in it fails.

    Raises ValueError naming the setting and the allowed values.
    """
    before = {name: _value(settings, name) for name in SETTING_NAMES}
    try:
        # The preset first: it sets the sliders, which may be given too.
        for name, value in sorted(values.items(), key=lambda item: item[0] != "preset"):
            _apply(settings, name, value)
        yield
    except BaseException:
        for name in SETTING_NAMES:
            if name != "preset" and _value(settings, name) != before[name]:
                setattr(settings, name, before[name])
        raise


def _value(settings: SkinSettings, name: str) -> Any:  # noqa: ANN401
    value = getattr(settings, name)
    return tuple(value) if isinstance(value, bpy.types.bpy_prop_array) else value


def _apply(settings: SkinSettings, name: str, value: Any) -> None:  # noqa: ANN401
    if name not in SETTING_NAMES:
        raise ValueError(f"make_skin has no setting '{name}'; it has: {', '.join(SETTING_NAMES)}")
    rna = settings.bl_rna.properties[name]
    upper = rna.type == "ENUM" and isinstance(value, str)
    try:
        if rna.type in ("INT", "FLOAT"):
            _check_range(rna, value)
        setattr(settings, name, ALIASES.get(name, {}).get(value.upper(), value.upper()) if upper else value)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"make_skin: {name} = {value!r} is not allowed: {error}") from error


def _check_range(rna: bpy.types.Property, value: Any) -> None:  # noqa: ANN401
    """Blender clamps numbers without a word and accepts what is not finite."""
    for number in np.ravel(np.asarray(value, np.float64)):
        if not rna.hard_min <= number <= rna.hard_max:
            raise ValueError(f"it has to be from {rna.hard_min:g} to {rna.hard_max:g}")


@lru_cache(maxsize=4096)
def as_typed(value: float) -> float:
    """The double that the user typed into a single-precision property: 1.8 where Blender stores 1.7999999523.

    That is the shortest decimal number that rounds to the stored value; so Eq. 1 is exact to the last digit.
    """
    return float(str(np.float32(value)))


def register() -> None:
    """Adds the properties to Blender's types."""
    bpy.utils.register_class(SkinSettings)
    bpy.utils.register_class(LutImages)
    bpy.types.Object.skinglow = PointerProperty(type=SkinSettings, name="Skin Glow", override=OVERRIDE)
    bpy.types.Image.skinglow = PointerProperty(type=LutImages, name="Skin Glow Images")


def unregister() -> None:
    """Removes the properties; values stored in files remain there."""
    del bpy.types.Image.skinglow
    del bpy.types.Object.skinglow
    bpy.utils.unregister_class(LutImages)
    bpy.utils.unregister_class(SkinSettings)
