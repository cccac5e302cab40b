# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes skins, queries what they show and removes them."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import bpy
import numpy as np

from ..errors import SkinError
from ..identity import key_of
from ..live import shape_update
from ..live.file_upgrade import upgrade
from ..live.live_update import update_scene
from ..live.rebuilt import Rebuilt
from ..live.shape_tiles import store_missing_tiles
from ..live.shape_update import ShapeReport, shape_report
from ..read import measured_geometry, working_space, world_image
from ..read.file_skins import skins_of_file
from ..read.scene_reading import MEDIUM_PROPERTY, ROW_PROPERTY, read_skin
from ..session import SESSION
from ..setting_values import applied
from ..show.frozen import is_frozen, read_frozen
from ..show.group_nodes import make_whole
from ..show.inner_groups import delete_group
from ..show.lut_image import group_layout, image_pair, read_row, remove_images, shown_image
from ..show.mask import fill_mask, remove_masks, store_masks
from ..show.material_settings import clear_material, reset_material
from ..show.skin_material import add_to_materials, choose_slots, chosen_materials
from ..show.tile_image import OBJECT_PROPERTIES, TILES
from ..skin_settings import MEASURING_NAMES, SETTING_NAMES
from ..table.lut_layout import shown_colors
from ..table.skin_tables import Table
from ..thickness import thickness_attribute
from ..thickness.tile_attribute import ensure_tiles, remove_tiles


class SkinState(NamedTuple):
    """The settings and the current state of a skin."""

    name: str  #: of the object
    mode: str  #: 'EXISTING', 'PAPER' or 'PHYSICAL'
    weights: str  #: 'OBJECT', 'SURFACE' or 'SHAPE'
    weights_bound: float | None  #: of a single weight, relative to its largest channel; None if lit per object
    point: tuple[float, float, float]  #: reference point of distances, world, scene units
    size: int  #: entries of its lookup
    max_thickness_mm: float  #: thickness at the last entry
    thickness_mm: tuple[float, float]  #: min and max over its vertices
    unit_mm: float  #: millimeters per scene unit
    row: int  #: of the lookup image, from the bottom
    rebuilt: tuple[Rebuilt, ...]  #: the tables that were computed
    shape: ShapeReport | None = None  #: how its light through its shape was found; None: it is lit in another way


def make_skin(
    obj: bpy.types.Object,
    thickness: Sequence[float] | None = None,
    slots: Iterable[int | str] | None = None,
    **settings: Any,  # noqa: ANN401
) -> SkinState:
    """Makes a mesh object glow: measures thickness, adds the lookup node to its materials, keeps it up to date.

    obj        a mesh object with faces, not in Edit Mode; its materials keep their surface
    thickness  custom thicknesses, mm, one per vertex, which are then kept; without it they are measured by ray tracing
               (only if the mesh, its scale or unit changed since the last time)
    slots      the material slots that are skin, by index or name of the material, without eyes or hair; by
               default those that were chosen before, at first all
    settings   any property of `obj.skinglow` (skin_settings.py): mode="physical"|"existing"|"paper" (also "fixed"
               and "tinted"), weights="object"|"surface"|"shape" (mode physical: lit per object, per pixel or through
               its shape), cell_mm and reentries (through its shape), strength,
               blood_weight, attenuation, reference="bounds"|"origin"|"point"|"object", reference_point (which
               implies "point"), reference_object and reference_bone (which imply "object"), size, max_thickness_mm,
               unit_mm, rays, ... Another call changes only the given ones.
    Raises SkinError if the object cannot be a skin, ValueError naming a setting that is not allowed.
    """

    def keep_or_measure() -> None:
        scene = bpy.context.scene
        if thickness is None:
            thickness_attribute.ensure_measured(obj, scene)
        else:
            thickness_attribute.store(obj, thickness, measured_geometry.unit_mm(obj, scene))

    return _make(obj, keep_or_measure, slots, settings)


def remake_skin(obj: bpy.types.Object, *, measure: bool) -> SkinState:
    """The same of a skin as it is; measure: whether its thickness is measured if its mesh, scale or unit changed."""

    def keep_or_measure() -> None:
        if measure:
            thickness_attribute.ensure_measured(obj, bpy.context.scene)

    return _make(obj, keep_or_measure, None, {})


def _make(
    obj: bpy.types.Object,
    store_thickness: Callable[[], object],
    slots: Iterable[int | str] | None,
    settings: dict[str, Any],
) -> SkinState:
    measured_geometry.check_mesh(obj)
    if "reference_point" in settings:
        settings.setdefault("reference", "POINT")
    if "reference_object" in settings:
        settings.setdefault("reference", "OBJECT")
    upgrade()  # a group that was appended from a file of an earlier version
    choose = choose_slots(obj, slots) if slots is not None else None
    with applied(obj.skinglow, settings):
        scene = bpy.context.scene
        store_thickness()
        if choose is not None:
            choose()
        group = add_to_materials(obj, obj.skinglow.group)
        make_whole(group)
        if obj.skinglow.group != group:
            obj.skinglow.group = group
            obj.skinglow.row = -1
        obj.skinglow.enabled = True
        for material in chosen_materials(obj):
            fill_mask(material)
        store_masks(obj)
        if obj.skinglow.mode == "PHYSICAL" and obj.skinglow.weights == "SHAPE" and obj.data.library is None:
            ensure_tiles(obj, scene)
        if ROW_PROPERTY not in obj:
            obj[ROW_PROPERTY] = (0.0, 0.0, 0.0, 0.0)
        obj.update_tag(refresh={"OBJECT"})
        depsgraph = bpy.context.evaluated_depsgraph_get()
        rebuilt = tuple(r for r in update_scene(depsgraph, made=obj) if r.key == key_of(obj))
        fault = SESSION.faults.get(key_of(obj))
        if fault is not None:
            raise SkinError(fault)
    return state_of(obj, depsgraph)._replace(rebuilt=rebuilt)


def state_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> SkinState:
    """The state of a skin in a depsgraph."""
    settings = skin_settings_of(obj)
    evaluated = obj.evaluated_get(depsgraph)
    values, known = thickness_attribute.read(obj.data)
    values = values[known]
    skin = read_skin(evaluated, evaluated.matrix_world)
    table = table_of(obj, depsgraph)
    return SkinState(
        name=obj.name,
        mode=skin.mode,
        weights=skin.weights,
        weights_bound=table.bound if table is not None else None,
        point=skin.point,
        size=skin.base[1],
        max_thickness_mm=skin.base[2],
        thickness_mm=(float(values.min()), float(values.max())) if len(values) else (0.0, 0.0),
        unit_mm=measured_geometry.unit_mm(obj, depsgraph.scene),
        row=settings.row,
        rebuilt=(),
        shape=shape_report(obj, depsgraph.mode),
    )


def table_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Table | None:
    """The table that a skin shows in depsgraphs of this mode; None before the first update."""
    group = obj.original.skinglow.group
    atlas = SESSION.atlases.get((key_of(group), depsgraph.mode)) if group is not None else None
    return atlas.tables.get(key_of(obj)) if atlas is not None else None


def update(depsgraph: bpy.types.Depsgraph) -> list[Rebuilt]:
    """Recomputes each lookup whose lights, world, position or settings changed; returns what was rebuilt and why.

    The handlers do the same whenever Blender reports a change. Raises SkinError with all faults after the other skins
    are updated; a skin with a fault keeps its last good lookup.
    """
    world_image.forget_edited()
    if depsgraph.mode == "VIEWPORT" and not SESSION.rendering and store_missing_tiles(skins_of_file()):
        depsgraph.update()
    rebuilt = update_scene(depsgraph)
    if SESSION.faults:
        raise SkinError("; ".join(SESSION.faults.values()))
    return rebuilt


def lut(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    """The lookup as the object's material shows it, (size, 3) float32, linear Rec.709, thin skin first.

    If the skin is lit per pixel, the lookup at the object's single weight.

    It is read from the image in the node; if viewport and render differ, from that of the depsgraph's mode. Raises
    SkinError if the object is not a skin.
    """
    settings = skin_settings_of(obj)
    group = settings.group
    layout = group_layout(group)
    if is_frozen(group):
        row = read_frozen(group, settings.row, depsgraph.scene.frame_current)
        size = len(row) if layout is None else layout.entries
        return working_space.to_rec709(row[:, :3] if layout is None else shown_colors(row, size, layout))
    pair = image_pair(group, depsgraph.mode)
    image = shown_image(group)
    atlas = SESSION.atlases.get((key_of(group), depsgraph.mode))
    if image not in pair and atlas is not None:
        image = pair[atlas.front]
    if image is None:
        raise SkinError(f"'{obj.name}': the image of its lookup was deleted: make the skin again")
    table = table_of(obj, depsgraph)
    if table is not None:
        size = len(table.colors)
    else:
        evaluated = obj.evaluated_get(depsgraph)
        size = read_skin(evaluated, evaluated.matrix_world).base[1]
    row = read_row(image, settings.row)
    return working_space.to_rec709(row[:size, :3].copy() if layout is None else shown_colors(row, size, layout))


def remove_skin(obj: bpy.types.Object) -> None:
    """Removes everything that `make_skin` added, unless another skin needs it."""
    settings = obj.skinglow
    group = settings.group
    settings.enabled = False
    settings.property_unset("group")
    settings.property_unset("thickness_image")
    for name in SETTING_NAMES:
        settings.property_unset(name)
    settings.property_unset("row")
    obj.pop(ROW_PROPERTY, None)
    obj.pop(MEDIUM_PROPERTY, None)
    shape_update.forget({key_of(obj)})
    for name in OBJECT_PROPERTIES:
        obj.pop(name, None)
    skins = skins_of_file()
    if not any(o.data == obj.data for o in skins):
        thickness_attribute.remove(obj.data)
        remove_tiles(obj.data)
        remove_masks(obj.data)
    used = {slot.material for o in skins for slot in o.material_slots}
    for slot in obj.material_slots:
        if slot.material is not None and slot.material not in used and slot.material.library is None:
            clear_material(slot.material)
            reset_material(slot.material)
    if group is not None and group.library is None and not any(o.skinglow.group == group for o in skins):
        TILES.remove(group)
        remove_images(group)
        if group.users == 0:
            delete_group(group)
        SESSION.forget_tables()
    obj.update_tag(refresh={"OBJECT"})


def set_medium(
    obj: bpy.types.Object,
    absorption: Sequence[float] | None = None,
    reduced_scattering: Sequence[float] | None = None,
    refractive_index: float = 1.4,
    surface: str = "rough",
) -> None:
    """Has light go through the shape of a skin as through a medium of three channels instead of a tissue.

    absorption, reduced_scattering
                      three numbers each, 1/mm, 0 to 1e5; None for both: the tissue of the sliders again
    refractive_index  1 to 3; outside is air
    surface           "rough" (light that crosses it forgets its direction) or "smooth" (Fresnel's reflectance)
    Raises ValueError naming the argument. A table that shows the skin is still that of the tissue.
    """
    skin_settings_of(obj)
    if absorption is None and reduced_scattering is None:
        obj.pop(MEDIUM_PROPERTY, None)
    else:
        channels = [*_channels("absorption", absorption), *_channels("reduced_scattering", reduced_scattering)]
        if not 1.0 <= refractive_index <= 3.0:
            raise ValueError(f"set_medium: refractive_index is {refractive_index}; allowed: 1 to 3")
        if surface not in ("rough", "smooth"):
            raise ValueError(f"set_medium: surface is {surface!r}; allowed: 'rough', 'smooth'")
        obj[MEDIUM_PROPERTY] = [*channels, float(refractive_index), float(surface == "smooth")]
    obj.update_tag(refresh={"OBJECT"})


def _channels(name: str, values: Sequence[float] | None) -> list[float]:
    found = np.asarray(values, np.float64) if values is not None else np.empty(0)
    if found.shape != (3,) or not ((found >= 0.0) & (found <= 1e5)).all():
        raise ValueError(f"set_medium: {name} is {values}; allowed: three numbers from 0 to 1e5, 1/mm")
    return found.tolist()


def reset_settings(obj: bpy.types.Object) -> None:
    """Resets the settings of `make_skin` to their defaults; the object stays a skin and keeps its thickness, and
    with it the settings by which that was measured.
    """
    for name in SETTING_NAMES:
        if name not in MEASURING_NAMES:
            obj.skinglow.property_unset(name)
    obj.update_tag(refresh={"OBJECT"})


def skin_settings_of(obj: bpy.types.Object) -> bpy.types.PropertyGroup:
    """The settings of a skin; raises SkinError if the object is not one."""
    if obj.type != "MESH" or not obj.skinglow.enabled or obj.skinglow.group is None:
        raise SkinError(f"'{obj.name}' is not a skin: call make_skin first")
    return obj.original.skinglow
