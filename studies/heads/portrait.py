"""Runs inside Blender: makes the shapes of human_head.py a person: skin, eyes, lashes, brows and short hair."""

from __future__ import annotations

import bpy  # isort: skip  (importing it makes the others importable in the wheels)
import numpy as np

from studies.heads import hair, person_materials
from studies.heads.human_head import Array, HumanHead, Part

#: Vertices nearer than this to where the bust was cut do not glow, meters.
CUT_MARGIN_M = 0.02
#: From the mouth's inside and the sockets outward the glow comes up over this.
INSIDE_MARGIN_M = 0.004
MASK_GROUP = "glow"


def build(head: HumanHead, levels: int = 2) -> bpy.types.Object:
    """Adds the person to the scene; returns the skin, whose first material slot alone is skin."""
    body = _object(head.body)
    density = {"hair": hair.scalp(head.body), "brow": hair.brows(head.body)}
    for name, values in {**density, "keep": _glowing(head)}.items():
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


def _glowing(head: HumanHead) -> Array:
    """1 where skin glows, 0 at the cut of the bust, at the mouth's inside, and on lids, behind which there are eyes."""
    body = head.body
    edges = np.sort(np.concatenate([body.faces[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    dark = [(body.vertices[np.unique(unique[count == 1])], CUT_MARGIN_M, 2.0 * CUT_MARGIN_M)]
    dark.append((body.vertices[np.unique(body.faces[head.is_inside])], 0.0, INSIDE_MARGIN_M))
    for eye in head.eyes:
        low, high = eye.vertices.min(axis=0), eye.vertices.max(axis=0)
        radius = 0.5 * float((high - low).max())
        dark.append((0.5 * (low + high)[None], 1.35 * radius, 1.75 * radius))
    keep = np.ones(len(body.vertices))
    for points, none, full in dark:
        distance = np.array([np.linalg.norm(points - vertex, axis=1).min() for vertex in body.vertices])
        keep = np.minimum(keep, np.clip((distance - none) / (full - none), 0.0, 1.0))
    return keep


def _mask_group(body: bpy.types.Object) -> None:
    """The vertex group that masks the glow, from the attribute."""
    values = np.empty(len(body.data.vertices), np.float32)
    body.data.attributes["keep"].data.foreach_get("value", values)
    group = body.vertex_groups.new(name=MASK_GROUP)
    group.add(np.flatnonzero(values >= 1.0).tolist(), 1.0, "REPLACE")
    for index in np.flatnonzero((values > 0.0) & (values < 1.0)).tolist():
        group.add([index], float(values[index]), "REPLACE")
