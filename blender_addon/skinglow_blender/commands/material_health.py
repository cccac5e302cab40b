# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be wrong with the materials of a skin."""

from typing import NamedTuple

import bpy

from ..show.mask import mask_groups
from ..show.skin_material import chosen_materials, gives_thickness, skin_node
from ..show.subsurface import light_shown_by

REPAIR = "press Repair, or call make_skin"


class Fault(NamedTuple):
    """What is wrong with a skin."""

    what: str
    remedy: str
    is_hint: bool = False  #: it glows as its settings say, but they are likely not what is wanted

    def __str__(self) -> str:
        return f"{self.what}: {self.remedy}"


def material_faults(obj: bpy.types.Object) -> list[Fault]:
    """The faults of a skin's materials; its node group is there."""
    chosen = chosen_materials(obj)
    nodes = {material: skin_node(material) for material in chosen}
    with_node = [m for m, node in nodes.items() if node is not None and node.node_tree == obj.skinglow.group]
    if not with_node:
        return [Fault("None of its materials has the Skinglow node, so it does not glow", REPAIR)]
    faults = [
        Fault(
            f"Material '{material.name}' has no Skinglow node, so its faces do not glow",
            "press Repair, or leave its slot out of the skin",
        )
        for material in chosen
        if material not in with_node
    ]
    faults += [
        Fault(
            f"It has no vertex group '{name}', by which a material is masked, so that does not glow",
            "add the group, or change the Mask of the material",
        )
        for name in sorted(mask_groups(obj) - set(obj.vertex_groups.keys()))
    ]
    faults += [
        Fault(
            f"Material '{material.name}' scatters light below its surface, which comes through it a second time",
            "choose who shows it under Material > Light Shown By",
            is_hint=True,
        )
        for material in with_node
        if light_shown_by(material) == "BOTH"
    ]
    return faults


def measured_slots(obj: bpy.types.Object) -> list[bool]:
    """For each material slot whether its faces need the measured thickness: skin without a thickness of its own."""
    chosen = chosen_materials(obj)
    return [slot.material in chosen and not gives_thickness(slot.material) for slot in obj.material_slots]
