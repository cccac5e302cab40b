# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: what new skins begin with, and whether skins follow the lights."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from .setting_choices import LIGHTINGS, MODES
from .tissue_presets import PRESETS

#: Where this add-on is installed; a script that imports the package has no preferences.
PACKAGE = __package__


#: Whether skins follow the lights, as last set: looking it up in the preferences at each edit would take 20 us.
_follows = True


def _live_changed(chosen: "SkinglowPreferences", _context: bpy.types.Context) -> None:
    global _follows
    _follows = chosen.live


class SkinglowPreferences(bpy.types.AddonPreferences):
    """Shown in Edit > Preferences > Add-ons."""

    bl_idname = PACKAGE

    live: BoolProperty(
        name="Follow the Lights",
        default=True,
        update=_live_changed,
        description="Update skins while lights are edited; if disabled, only Update Now, frame changes and renders do",
    )
    mode: EnumProperty(name="Mode", items=MODES, default="PHYSICAL", description="Mode of new skins")
    weights: EnumProperty(name="Lighting", items=LIGHTINGS, default="SHAPE", description="Lighting of new skins")
    preset: EnumProperty(name="Preset", items=PRESETS[1:], default="LIGHT", description="Preset of new skins")
    unit_mm: FloatProperty(
        name="Unit",
        subtype="DISTANCE_CAMERA",
        default=0.0,
        min=0.0,
        max=1e9,
        description="Length of one Blender unit in new skins; 0 uses the unit scale of the scene",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "live")
        column = layout.column(heading="New Skins")
        for name in ("mode", "weights", "preset", "unit_mm"):
            column.prop(self, name)
        layout.operator("skinglow.manual", icon="HELP")


def preferences() -> SkinglowPreferences | None:
    """The preferences; None where the package is not installed as an add-on."""
    addon = bpy.context.preferences.addons.get(PACKAGE)
    return addon.preferences if addon is not None else None


def follows_lights() -> bool:
    """Whether handlers update skins."""
    return _follows


def of_new_skins() -> dict[str, object]:
    """The settings that a new skin made by a button begins with, where they differ from the defaults."""
    chosen = preferences()
    if chosen is None:
        return {}
    names = ("mode", "weights", "preset", "unit_mm")
    return {name: getattr(chosen, name) for name in names if chosen.is_property_set(name)}


def register() -> None:
    """Adds the preferences."""
    global _follows
    bpy.utils.register_class(SkinglowPreferences)
    chosen = preferences()
    _follows = chosen is None or chosen.live


def unregister() -> None:
    """Removes the preferences; their values stay in the user's settings."""
    bpy.utils.unregister_class(SkinglowPreferences)
