# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user sets on a skin: a property group on every object, `obj.skinglow`."""

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
)

from .errors import core

MODES = (
    ("EXISTING", "Existing", "A fixed reddish lookup: the skin glows in the same color, whatever the lights do"),
    ("PAPER", "Paper", "Base lookup times blood weight plus the attenuated light colors (Kim et al., Eq. 1 to 3)"),
    ("PHYSICAL", "Physical", "Layered skin, solved, lit by what each light brings to its far side in W/m^2"),
)
WEIGHTS = (
    (
        "OBJECT",
        "Object",
        "One weight for the whole object: each lamp as if the far side faced it, at the reference point",
    ),
    (
        "SURFACE",
        "Surface",
        "The light is worked out at each pixel, on the far side, with its angle: for lamps that are near",
    ),
    ("AUTO", "Automatic", "Surface, where one weight for the object may be more than 5 % off anywhere on it"),
)
BASES = (
    ("BUILTIN", "Built-in", "Brightness of the six-Gaussian skin profile (d'Eon and Luebke 2007)"),
    ("IMAGE", "Image", "Brightness of an image's columns, thin skin at its left, thick at its right"),
    ("SKIN", "Skin", "Brightness of the skin that the sliders describe"),
)
REFERENCES = (
    ("BOUNDS", "Bounds", "Center of the evaluated mesh's bounding box"),
    ("ORIGIN", "Origin", "The object's origin"),
    ("POINT", "Point", "A point of the world that you give"),
)


def _changed(settings: "SkinSettings", _context: bpy.types.Context) -> None:
    """Add-on properties report nothing to Blender by themselves; without the tag the handlers would not run."""
    if settings.enabled:
        settings.id_data.update_tag(refresh={"OBJECT"})


#: The core's named skins (skinglow.TISSUE_PRESETS).
PRESETS = (
    ("CUSTOM", "Custom", "As the sliders stand"),
    ("VERY_LIGHT", "Very light", "Very little melanin"),
    ("LIGHT", "Light", "Light skin, as the paper's head"),
    ("MEDIUM", "Medium", "Medium pigmentation"),
    ("DARK", "Dark", "Dark skin"),
    ("VERY_DARK", "Very dark", "Very much melanin"),
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
_taking_preset = False


def _preset_chosen(settings: "SkinSettings", context: bpy.types.Context) -> None:
    global _taking_preset
    if settings.preset == "CUSTOM":
        return
    tissue = core().TISSUE_PRESETS[settings.preset.lower()]
    _taking_preset = True
    try:
        for name in TISSUE_SLIDERS:
            setattr(settings, name, getattr(tissue, name))
    finally:
        _taking_preset = False
    _changed(settings, context)


def _slider_moved(settings: "SkinSettings", context: bpy.types.Context) -> None:
    if _taking_preset:
        return
    if settings.preset != "CUSTOM":
        settings.preset = "CUSTOM"
    _changed(settings, context)


class SkinSettings(bpy.types.PropertyGroup):
    """One skin. `make_skin` takes each property that is not hidden by its name."""

    enabled: BoolProperty(name="Skin", description="This object is a skin that glows", options={"HIDDEN"})
    live: BoolProperty(
        name="Live",
        default=True,
        update=_changed,
        description="Follow the lights as they change; off: only 'Update now' does",
    )
    mode: EnumProperty(
        name="Mode",
        items=MODES,
        default="PAPER",
        update=_changed,
        description="How the light coming through is computed",
    )
    weights: EnumProperty(
        name="Weights",
        items=WEIGHTS,
        default="OBJECT",
        update=_changed,
        description="Whether the lamps are weighed once for the object or at each pixel (mode physical)",
    )
    strength: FloatProperty(
        name="Strength",
        default=1.0,
        min=0.0,
        soft_max=10.0,
        update=_changed,
        description="Factor on the light coming through; 1 shows the lookup as it is",
    )
    base: EnumProperty(
        name="Base",
        items=BASES,
        default="BUILTIN",
        update=_changed,
        description="The base lookup that holds brightness only, by thickness",
    )
    base_image: PointerProperty(
        name="Image",
        type=bpy.types.Image,
        update=_changed,
        description="Base lookup; its middle row is read, color is reduced to brightness",
    )
    blood_weight: FloatVectorProperty(
        name="Blood",
        subtype="COLOR",
        size=3,
        default=(1.8, 0.5, 0.4),
        min=0.0,
        soft_max=4.0,
        max=1e6,
        update=_changed,
        description="B of Eq. 1, added to the light weight; the paper's is 1.8, 0.5, 0.4",
    )
    attenuation: FloatVectorProperty(
        name="Attenuation",
        size=3,
        default=(1.0, 0.0, 1.0),
        min=0.0,
        soft_max=10.0,
        precision=3,
        update=_changed,
        description="Constant, linear and quadratic coefficient of Eq. 2, for distances in scene units",
    )
    preset: EnumProperty(
        name="Skin", items=PRESETS, default="LIGHT", update=_preset_chosen, description="A skin to start from"
    )
    melanin_fraction: FloatProperty(
        name="Melanin",
        default=0.038,
        min=0.0,
        max=0.5,
        precision=3,
        update=_slider_moved,
        description="Melanosomes, volume fraction of the epidermis",
    )
    blood_fraction: FloatProperty(
        name="Blood volume",
        default=0.01,
        min=0.0,
        max=0.1,
        precision=4,
        update=_slider_moved,
        description="Whole blood of 150 g/L hemoglobin, volume fraction of the dermis",
    )
    oxygen_saturation: FloatProperty(
        name="Oxygen",
        default=0.75,
        min=0.0,
        max=1.0,
        update=_slider_moved,
        description="Oxygenated part of the hemoglobin",
    )
    epidermal_thickness_mm: FloatProperty(
        name="Epidermis",
        default=0.06,
        min=0.0,
        max=0.3,
        precision=3,
        update=_slider_moved,
        description="Thickness of each of the two epidermes, mm",
    )
    scattering_scale: FloatProperty(
        name="Scattering",
        default=1.0,
        min=0.1,
        max=3.0,
        update=_slider_moved,
        description="Multiplies the scattering of every layer",
    )
    refractive_index: FloatProperty(
        name="Index",
        default=1.4,
        min=1.0,
        max=1.6,
        update=_slider_moved,
        description="Refractive index of every layer; outside is air",
    )
    cartilage_fraction: FloatProperty(
        name="Cartilage",
        default=0.0,
        min=0.0,
        max=1.0,
        update=_slider_moved,
        description="Cartilage, volume fraction of the inner layer",
    )
    reference: EnumProperty(
        name="Measured at",
        items=REFERENCES,
        default="BOUNDS",
        update=_changed,
        description="Where distances to the lights are measured",
    )
    reference_point: FloatVectorProperty(
        name="Point", subtype="XYZ", size=3, update=_changed, description="World position, scene units"
    )
    size: IntProperty(
        name="Texels",
        default=256,
        min=1,
        soft_max=1024,
        max=65536,
        update=_changed,
        description="Entries of the lookup",
    )
    max_thickness_mm: FloatProperty(
        name="Thickest",
        default=12.0,
        min=1e-3,
        soft_max=50.0,
        max=1e6,
        update=_changed,
        description="Thickness at the lookup's last entry, mm; thicker skin shows that entry",
    )
    unit_mm: FloatProperty(
        name="Unit",
        default=0.0,
        min=0.0,
        soft_max=1000.0,
        max=1e9,
        precision=3,
        update=_changed,
        description="Millimeters in one Blender unit; 0: as the scene's unit scale says (1000 by default)",
    )
    rays: IntProperty(
        name="Rays",
        default=64,
        min=1,
        soft_max=512,
        max=65536,
        description="Rays per vertex when the thickness is measured",
    )
    min_openness: FloatProperty(
        name="Openness",
        default=0.1,
        min=0.0,
        max=1.0,
        description="Far sides that see less of the sky than this are dark (mouth, eye sockets) and let no light in; "
        "0: every far side counts",
    )
    group: PointerProperty(type=bpy.types.ShaderNodeTree, options={"HIDDEN"})
    row: IntProperty(default=-1, options={"HIDDEN"})


class LutImages(bpy.types.PropertyGroup):
    """The images that a skin node group shows in turn, on each of them (lut_image.py says why there are four).

    Not on the node group: Blender counts users wrongly where a node tree's own properties point to data.
    """

    viewport_a: PointerProperty(type=bpy.types.Image)
    viewport_b: PointerProperty(type=bpy.types.Image)
    render_a: PointerProperty(type=bpy.types.Image)
    render_b: PointerProperty(type=bpy.types.Image)


#: The names that `make_skin` takes.
SETTING_NAMES = tuple(name for name in SkinSettings.__annotations__ if name not in ("enabled", "group", "row"))


def apply_settings(settings: SkinSettings, values: dict[str, Any]) -> None:
    """Sets properties by name; raises ValueError naming the setting and what is allowed."""
    # A preset first: what else is given changes it.
    for name, value in sorted(values.items(), key=lambda item: item[0] != "preset"):
        if name not in SETTING_NAMES:
            raise ValueError(f"make_skin has no setting '{name}'; it has: {', '.join(SETTING_NAMES)}")
        items = settings.bl_rna.properties[name]
        upper = items.type == "ENUM" and isinstance(value, str)
        try:
            setattr(settings, name, value.upper() if upper else value)
        except (TypeError, ValueError) as error:
            raise ValueError(f"make_skin: {name} = {value!r} is not allowed: {error}") from error


@lru_cache(maxsize=4096)
def as_typed(value: float) -> float:
    """The double a person meant by a single-precision property: 1.8 where Blender stores 1.7999999523.

    That is the shortest decimal number that rounds to the stored one, so that Eq. 1 is followed to the digit.
    """
    return float(str(np.float32(value)))


def register() -> None:
    """Adds the properties to Blender's types."""
    bpy.utils.register_class(SkinSettings)
    bpy.utils.register_class(LutImages)
    bpy.types.Object.skinglow = PointerProperty(type=SkinSettings, name="Skin glow")
    bpy.types.Image.skinglow = PointerProperty(type=LutImages, name="Skin glow images")


def unregister() -> None:
    """Takes the properties away; what is stored in files stays in them."""
    del bpy.types.Image.skinglow
    del bpy.types.Object.skinglow
    bpy.utils.unregister_class(LutImages)
    bpy.utils.unregister_class(SkinSettings)
