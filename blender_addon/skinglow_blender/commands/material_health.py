# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be wrong with the materials of a skin."""

from typing import NamedTuple

import bpy

from ..show.mask import image_fault, mask_groups
from ..show.skin_material import chosen_materials, gives_thickness, is_shown, skin_node, skin_nodes
from ..show.subsurface import has_subsurface, light_shown_by

REPAIR = "press Repair, or call make_skin"
UNMUTE = "select it in the Shader Editor and press M"
CHOOSE_MASK = "choose another image under Material > Mask, or File > External Data > Find Missing Files"
CHOOSE_SHOWN_BY = "choose who shows it under Material > Light Shown By"


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
            f"The Skinglow node of material '{material.name}' is not connected to its output, so its faces do not glow",
            "press Repair, or leave its slot out of the skin",
        )
        for material in with_node
        if not is_shown(material)
    ]
    faults += [
        Fault(
            f"The Skinglow node of material '{material.name}' is muted, so its faces do not glow",
            UNMUTE,
            is_hint=True,
        )
        for material in with_node
        if all(node.mute for node in skin_nodes(material)) and not has_subsurface(material)
    ]
    faults += [
        Fault(
            f"It has no vertex group '{name}', by which a material is masked, so that does not glow",
            "add the group, or change the Mask of the material",
        )
        for name in sorted(mask_groups(obj) - set(obj.vertex_groups.keys()))
    ]
    faults += [Fault(what, CHOOSE_MASK) for what in map(image_fault, with_node) if what]
    faults += [
        Fault(
            f"Material '{material.name}' scatters light below its surface, which comes through it a second time",
            CHOOSE_SHOWN_BY,
            is_hint=True,
        )
        for material in with_node
        if light_shown_by(material) == "BOTH"
    ]
    return faults


def layer_faults(obj: bpy.types.Object, layer: bpy.types.ViewLayer) -> list[Fault]:
    """What a view layer shows in place of a skin's materials."""
    faults = []
    if layer.material_override is not None:
        what = f"View layer '{layer.name}' shows material '{layer.material_override.name}' in place of all others"
        faults.append(
            Fault(f"{what}, so it does not glow there", "clear View Layer > Override > Material", is_hint=True)
        )
    for name, words, is_on in (
        ("Holdout", "a holdout", obj.is_holdout or obj.holdout_get(view_layer=layer)),
        ("Shadow Catcher", "a shadow catcher", obj.is_shadow_catcher),
    ):
        if is_on:
            remedy = f"turn off {name} under Object Properties > Visibility, or that of its collection"
            faults.append(Fault(f"It is {words}, so it does not glow", remedy, is_hint=True))
    return faults


def measured_slots(obj: bpy.types.Object) -> list[bool]:
    """For each material slot whether its faces need the measured thickness: skin without a thickness of its own."""
    chosen = chosen_materials(obj)
    return [slot.material in chosen and not gives_thickness(slot.material) for slot in obj.material_slots]
