# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a scene: a property group on every scene, `scene.skinglow`."""

import bpy
from bpy.props import BoolProperty, PointerProperty


def _changed(settings: "SceneSettings", _context: bpy.types.Context) -> None:
    """Tags the scene: Blender does not report changes of add-on properties to the handlers."""
    settings.id_data.update_tag()


class SceneSettings(bpy.types.PropertyGroup):
    """Settings for all skins of a scene."""

    occlusion: BoolProperty(
        name="Occlusion",
        default=False,
        update=_changed,
        description="Let other objects block light on its way to the back of the skin (Physical mode)",
    )


def register() -> None:
    """Adds the properties to Blender's scenes."""
    bpy.utils.register_class(SceneSettings)
    bpy.types.Scene.skinglow = PointerProperty(type=SceneSettings, name="Skin Glow")


def unregister() -> None:
    """Removes the properties; values stored in files remain there."""
    del bpy.types.Scene.skinglow
    bpy.utils.unregister_class(SceneSettings)
