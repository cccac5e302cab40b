# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the changes that Blender reports can change what a skin shows: all others cost nothing."""

from typing import NamedTuple

import bpy

from ..identity import key_of, lasting_key_of
from ..read.scene_reading import has_geometry_nodes
from ..session import SESSION
from ..show.group_following import may_change_groups

#: Types of data whose changes cannot affect a light, the world or a skin by themselves. What follows from them, such as
#: the shape of an object after its mesh was edited, is reported as a change of the object.
IRRELEVANT = frozenset(
    "Action Armature Brush Camera Curve Image Key Lattice Material Mesh MetaBall Screen Text Texture "
    "WindowManager".split()
)


class Changes(NamedTuple):
    """What an evaluation's report means for skins."""

    skins: bool  #: a light, a skin or the world may have changed, or what instances them
    materials: bool  #: a skin may have got another material
    images: frozenset[str]  #: lasting_key_of the images that changed
    reshaped: tuple[bpy.types.Object, ...]  #: the skins whose mesh, or what is painted on it, changed


def changes_of(depsgraph: bpy.types.Depsgraph) -> Changes:
    """Reads the report once: Blender goes through all data of the scene each time.

    With Occlusion on every object matters: it may stand between a light and a skin.
    """
    skins, materials, images, reshaped, number = depsgraph.scene.skinglow.occlusion, False, set(), [], 0
    for number, update in enumerate(depsgraph.updates, 1):  # noqa: B007  the number of updates
        changed = update.id
        if isinstance(changed, bpy.types.Object):
            kind = changed.type
            is_skin = kind == "MESH" and changed.skinglow.enabled
            skins = skins or is_skin or _may_change_skins(changed, kind)
            materials = materials or may_change_groups(update, kind)
            if is_skin and update.is_updated_geometry:
                reshaped.append(changed.original)
            continue
        skins = skins or type(changed).__name__ not in IRRELEVANT
        materials = materials or isinstance(changed, bpy.types.Material)
        if isinstance(changed, bpy.types.Image):
            images.add(lasting_key_of(changed))
    # Blender 3.4 reports changed images without saying which.
    return Changes(skins or number == 0, materials, frozenset(images), tuple(reshaped))


def _may_change_skins(changed: bpy.types.Object, kind: str) -> bool:
    """Whether an object that is no skin may be a light, instance one, or be a skin's point of reference."""
    if kind == "LIGHT" or changed.is_instancer:
        return True
    if SESSION.reference_objects and key_of(changed) in SESSION.reference_objects:
        return True
    return has_geometry_nodes(changed)
