# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator on a skin's materials."""

import bpy
from bpy.props import EnumProperty

from ..errors import SkinError
from ..show.skin_material import chosen_materials
from ..show.subsurface import SHOWN_BY, has_subsurface, show_light_by
from .operators import SelectedSkinsOperator, selected_skins


class SKINGLOW_OT_show_light_by(SelectedSkinsOperator, bpy.types.Operator):  # noqa: N801  Blender's naming
    """Counts the light once that both the skin and the subsurface of its shader bring through."""

    bl_idname = "skinglow.show_light_by"
    bl_label = "Show Skin Glow By"
    bl_description = (
        "Choose who shows the light that comes through, where the shader of a selected skin scatters light below the "
        "surface too"
    )

    shown_by: EnumProperty(name="Light Shown By", items=SHOWN_BY)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The tooltip of each of the two buttons."""
        return next(text for name, _label, text in SHOWN_BY if name == properties.shown_by)

    def execute(self, context: bpy.types.Context) -> set[str]:
        def hand_over() -> str:
            materials = dict.fromkeys(m for obj in selected_skins(context) for m in chosen_materials(obj))
            scattering = [material for material in materials if has_subsurface(material)]
            if not scattering:
                raise SkinError("The materials of the selected skins have no subsurface, so light is counted once")
            for material in scattering:
                show_light_by(material, self.shown_by)
            label = next(label for name, label, _text in SHOWN_BY if name == self.shown_by)
            return f"Light is shown by {label} in {', '.join(material.name for material in scattering)}"

        return self.attempt(hand_over)


def register() -> None:
    """Adds the operator."""
    bpy.utils.register_class(SKINGLOW_OT_show_light_by)


def unregister() -> None:
    """Removes the operator."""
    bpy.utils.unregister_class(SKINGLOW_OT_show_light_by)
