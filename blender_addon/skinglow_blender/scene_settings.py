# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user sets on a scene: a property group on every scene, `scene.skinglow`."""

import bpy
from bpy.props import BoolProperty, PointerProperty


def _changed(settings: "SceneSettings", _context: bpy.types.Context) -> None:
    """Add-on properties report nothing to Blender by themselves; without the tag the handlers would not run."""
    settings.id_data.update_tag()


class SceneSettings(bpy.types.PropertyGroup):
    """What holds for all skins of a scene."""

    occlusion: BoolProperty(
        name="Occlusion",
        default=False,
        update=_changed,
        description="Other objects stand between the lamps and the far side of skins (mode physical)",
    )


def register() -> None:
    """Adds the properties to Blender's scenes."""
    bpy.utils.register_class(SceneSettings)
    bpy.types.Scene.skinglow = PointerProperty(type=SceneSettings, name="Skin glow")


def unregister() -> None:
    """Takes the properties away; what is stored in files stays in them."""
    del bpy.types.Scene.skinglow
    bpy.utils.unregister_class(SceneSettings)
