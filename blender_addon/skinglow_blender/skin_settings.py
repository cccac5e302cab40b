# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a skin: a property group on every object, `obj.skinglow`.

Files store settings by property name: names must not change, labels may.
"""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .session import SESSION
from .setting_choices import BASES, LIGHTINGS, MODES, REFERENCES
from .tissue_presets import PRESETS, preset_of_sliders, set_sliders


def _changed(settings: "SkinSettings", _context: bpy.types.Context) -> None:
    """Tags the object: Blender does not report changes of add-on properties to the handlers."""
    if settings.enabled:
        settings.id_data.update_tag(refresh={"OBJECT"})


def _lit_otherwise(settings: "SkinSettings", context: bpy.types.Context) -> None:
    """The skin may be lit through its shape now, which needs tiles."""
    SESSION.may_lack_tiles = True
    # Of a skin that is hidden Blender reports nothing, and it needs other nodes, too.
    SESSION.known.clear()
    _changed(settings, context)


#: Options of what decides the nodes and images of a skin, of which none can be added while a window renders:
#: frames would show what the viewport had when the render began.
NOT_ANIMATED: set[str] = set()


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
        options=NOT_ANIMATED,
        update=_lit_otherwise,
        description="How the transmitted light is computed",
    )
    weights: EnumProperty(
        name="Lighting",
        items=LIGHTINGS,
        default="OBJECT",
        options=NOT_ANIMATED,
        update=_lit_otherwise,
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
        options=NOT_ANIMATED,
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
        get=preset_of_sliders,
        set=set_sliders,
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
        options=NOT_ANIMATED,
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
        options=set(),
        update=_changed,
        description="Length of one Blender unit in mm; 0 uses the unit scale of the scene (1000 by default)",
    )
    rays: IntProperty(
        name="Rays",
        default=64,
        min=1,
        soft_max=512,
        max=65536,
        options=set(),
        description="Number of rays per vertex for measuring the thickness",
    )
    min_openness: FloatProperty(
        name="Min Sky Visibility",
        subtype="FACTOR",
        default=0.1,
        min=0.0,
        max=1.0,
        options=set(),
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


# A library's skin can be overridden in the file that uses it, and keeps what was set there.
OVERRIDE = {"LIBRARY_OVERRIDABLE"}
for _property in SkinSettings.__annotations__.values():
    _property.keywords["override"] = OVERRIDE

#: What `make_skin` does not accept, and all that it does.
NO_SETTINGS = ("enabled", "thickness_image", "group", "row")
SETTING_NAMES = tuple(name for name in SkinSettings.__annotations__ if name not in NO_SETTINGS)


#: Of these: how thickness is measured.
MEASURING_NAMES = ("unit_mm", "rays", "min_openness")


def register() -> None:
    """Adds the properties to Blender's objects."""
    bpy.utils.register_class(SkinSettings)
    bpy.types.Object.skinglow = PointerProperty(type=SkinSettings, name="Skin Glow", override=OVERRIDE)


def unregister() -> None:
    """Removes the properties; values stored in files remain there."""
    del bpy.types.Object.skinglow
    bpy.utils.unregister_class(SkinSettings)
