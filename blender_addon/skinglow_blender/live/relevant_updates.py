# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the changes that Blender reports can change what a skin shows: all others cost nothing."""

from typing import NamedTuple

import bpy

from ..identity import key_of, lasting_key_of
from ..read.known_objects import Known, may_instance
from ..session import SESSION
from ..show.group_following import changes_groups

#: Types of data whose changes cannot affect a light, the world or a skin by themselves. What follows from them, such as
#: the shape of an object after its mesh was edited, is reported as a change of the object.
IRRELEVANT = frozenset(
    "Action Armature Brush Camera Curve Image Key Lattice Material Mesh MetaBall Screen Text Texture "
    "WindowManager".split()
)
#: Looked up once: `bpy.types` searches all types by name.
Image, Material, Mesh = bpy.types.Image, bpy.types.Material, bpy.types.Mesh
Object, Scene = bpy.types.Object, bpy.types.Scene
#: Types whose changes neither add lights or skins to a scene nor remove them.
ADDS_NOTHING = frozenset("AreaLight PointLight ShaderNodeTree SpotLight SunLight World".split())


class Changes(NamedTuple):
    """What an evaluation's report means for skins."""

    skins: bool  #: a light, a skin or the world may have changed, or what instances them
    objects: bool  #: what is known of the depsgraph's objects no longer holds
    materials: bool  #: a skin may have got another material
    images: frozenset[str]  #: lasting_key_of the images that changed
    reshaped: tuple[bpy.types.Object, ...]  #: the skins whose mesh, or what is painted on it, changed
    meshes: frozenset[str]  #: key_of the meshes that changed themselves; a pose changes none


def changes_of(depsgraph: bpy.types.Depsgraph, known: Known | None, is_frame: bool = False) -> Changes:
    """Reads the report once: Blender goes through all data of the scene each time.

    With Occlusion on every object matters: it may stand between a light and a skin.

    known     what the last reading of this depsgraph found; None: nothing is known
    is_frame  whether the frame was changed, so that anything may be hidden or shown
    """
    found, scene_changed, number = _Changes(known), is_frame, 0
    for number, update in enumerate(depsgraph.updates, 1):  # noqa: B007  the number of updates
        changed = update.id
        if isinstance(changed, Object):
            found.take_object(update, changed)
        elif isinstance(changed, Scene):
            scene_changed = True
        else:
            found.take_data(changed)
    # Blender 3.4 reports changed images without saying which.
    is_empty = number == 0 and not is_frame
    if known is None:
        objects = found.skins or scene_changed or is_empty or depsgraph.scene.skinglow.occlusion
    else:
        # Selecting something changes the scene, too.
        objects = found.objects or is_empty or (scene_changed and not known.still_holds(depsgraph))
    images, meshes = frozenset(found.images), frozenset(found.meshes)
    return Changes(found.skins or objects, objects, found.materials, images, tuple(found.reshaped), meshes)


class _Changes:
    """What is found in a report."""

    def __init__(self, known: Known | None) -> None:
        self.known = known
        self.skins = self.objects = self.materials = False
        self.images: set[str] = set()
        self.meshes: set[str] = set()
        self.reshaped: list[bpy.types.Object] = []

    def take_object(self, update: bpy.types.DepsgraphUpdate, changed: bpy.types.Object) -> None:
        kind = changed.type
        matters = kind == "LIGHT"
        if kind == "MESH" and changed.skinglow.enabled:
            matters = True
            # A move gives no skin another material.
            self.materials = self.materials or update.is_updated_geometry or update.is_updated_shading
            if update.is_updated_geometry:
                self.reshaped.append(changed.original)
        if matters:
            self.objects = self.objects or self._is_new(key_of(changed))
        if may_instance(changed):
            key = key_of(changed)
            # One that instances no light and no skin may be moved.
            if update.is_updated_geometry or self._is_new(key) or key in self.known.instancing:
                matters = self.objects = True
        self.skins = self.skins or matters
        if SESSION.reference_objects and key_of(changed) in SESSION.reference_objects:
            self.skins = True

    def _is_new(self, key: str) -> bool:
        try:
            return self.known is None or key not in self.known.keys
        except ReferenceError:  # something that was known is deleted
            return True

    def take_data(self, changed: bpy.types.ID) -> None:
        if isinstance(changed, Material):
            self.materials = self.materials or changes_groups(changed.original)
        elif isinstance(changed, Image):
            self.images.add(lasting_key_of(changed))
        elif isinstance(changed, Mesh):
            self.meshes.add(key_of(changed))
        # The nodes of a light, a world or a material are reported with it.
        elif type(changed).__name__ not in IRRELEVANT and not changed.is_embedded_data:
            self.skins = True
            self.objects = self.objects or type(changed).__name__ not in ADDS_NOTHING
