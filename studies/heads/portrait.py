"""Runs inside Blender: makes the shapes of human_head.py a person: skin, eyes, lashes, brows and short hair."""

from __future__ import annotations

import bpy  # isort: skip  (importing it makes the others importable in the wheels)
import numpy as np

from studies.heads import hair, person_materials
from studies.heads.human_head import Array, HumanHead, Part

#: Vertices nearer than this to where the bust was cut do not glow, meters.
CUT_MARGIN_M = 0.02
MASK_GROUP = "glow"


def build(head: HumanHead, levels: int = 2) -> bpy.types.Object:
    """Adds the person to the scene; returns the skin, whose first material slot alone is skin."""
    body = _object(head.body)
    density = {"hair": hair.scalp(head.body), "brow": hair.brows(head.body)}
    for name, values in {**density, "keep": _away_from_the_cut(head.body)}.items():
        body.data.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))
    neutral = body.data.attributes.new("neutral", "FLOAT_VECTOR", "POINT")
    neutral.data.foreach_set("vector", head.body.neutral.astype(np.float32).ravel())
    body.data.polygons.foreach_set("material_index", head.is_inside.astype(np.int32))
    subdivide(body, levels)
    body.name = "head"
    for material in (person_materials.skin(head.masks), person_materials.inside()):
        body.data.materials.append(material)
    _mask_group(body)
    for part in head.eyes:
        eye = _object(part)
        person_materials.mark_iris(eye, part)
        subdivide(eye, levels)
        eye.data.materials.append(person_materials.eye())
    fine = hair.Surface(body.data)
    strands = [hair.grow_scalp(fine), hair.grow_brows(fine)]
    # Two helpers an eye.
    strands += [hair.grow_lashes(part, head.eyes[index // 2]) for index, part in enumerate(head.lashes)]
    grown = hair.mesh_of("hair", strands)
    grown.data.materials.append(person_materials.hair())
    return body


def _object(part: Part) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(part.name)
    mesh.from_pydata(part.vertices.tolist(), [], part.faces.tolist())
    mesh.uv_layers.new(name="UV").data.foreach_set("uv", part.uv.astype(np.float32).ravel())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(part.faces), bool))
    made = bpy.data.objects.new(part.name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def subdivide(thing: bpy.types.Object, levels: int) -> None:
    """Catmull-Clark, applied."""
    modifier = thing.modifiers.new("smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = levels
    fine = bpy.data.meshes.new_from_object(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    thing.modifiers.clear()
    coarse, thing.data = thing.data, fine
    bpy.data.meshes.remove(coarse)


def _away_from_the_cut(body: Part) -> Array:
    """1 where skin glows, 0 near edges of one face; the lids and the mouth are closed surfaces, so that is the cut."""
    edges = np.sort(np.concatenate([body.faces[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    border = body.vertices[np.unique(unique[count == 1])]
    if not len(border):
        return np.ones(len(body.vertices))
    distance = np.array([np.linalg.norm(border - point, axis=1).min() for point in body.vertices])
    return np.clip(distance / CUT_MARGIN_M - 1.0, 0.0, 1.0)


def _mask_group(body: bpy.types.Object) -> None:
    """The vertex group that masks the glow, from the attribute."""
    values = np.empty(len(body.data.vertices), np.float32)
    body.data.attributes["keep"].data.foreach_get("value", values)
    group = body.vertex_groups.new(name=MASK_GROUP)
    group.add(np.flatnonzero(values >= 1.0).tolist(), 1.0, "REPLACE")
    for index in np.flatnonzero((values > 0.0) & (values < 1.0)).tolist():
        group.add([index], float(values[index]), "REPLACE")
