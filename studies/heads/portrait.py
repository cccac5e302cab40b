"""Runs inside Blender: makes the shapes of human_head.py a person: skin, eyes, lashes, brows and short hair."""

from __future__ import annotations

import bpy  # isort: skip  (importing it makes the others importable in the wheels)
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from studies.heads import hair, person_materials
from studies.heads.human_head import Array, HumanHead, Part

#: Vertices nearer than this to where the bust was cut do not glow, meters.
CUT_MARGIN_M = 0.02
#: From the mouth's inside and the sockets outward the glow comes up over this.
INSIDE_MARGIN_M = 0.004
MASK_GROUP = "glow"
#: What is looked at for cavities: from the eyes' middles outward and downward.
FACE_BESIDE_M, FACE_BELOW_M = 0.015, 0.09
#: In a cavity less of the sky is seen than this, weighted by the cosine.
CAVITY_SEES = 0.5
LIFT_M = 1e-4


def _directions(count: int) -> Array:
    """Spread evenly over the sphere, (count, 3): Fibonacci's lattice."""
    up = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    around = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    return np.column_stack([np.sqrt(1.0 - up**2) * f for f in (np.cos(around), np.sin(around))] + [up])


SKY = _directions(64)


def build(head: HumanHead, levels: int = 2) -> bpy.types.Object:
    """Adds the person to the scene; returns the skin, whose first material slot alone is skin."""
    body = object_of(head.body)
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
        eye = object_of(part)
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


def object_of(part: Part) -> bpy.types.Object:
    """Adds the part to the scene, as it is."""
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
    """1 where skin glows, 0 at the cut of the bust, in mouth and nostrils, and on lids, behind which there are eyes."""
    body = head.body
    edges = np.sort(np.concatenate([body.faces[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    dark = [(body.vertices[np.unique(unique[count == 1])], CUT_MARGIN_M, 2.0 * CUT_MARGIN_M)]
    dark.append((body.vertices[np.unique(body.faces[head.is_inside])], 0.0, INSIDE_MARGIN_M))
    dark.append((body.vertices[_cavities(head)], INSIDE_MARGIN_M, 2.0 * INSIDE_MARGIN_M))
    for eye in head.eyes:
        low, high = eye.vertices.min(axis=0), eye.vertices.max(axis=0)
        radius = 0.5 * float((high - low).max())
        dark.append((0.5 * (low + high)[None], 1.35 * radius, 1.75 * radius))
    keep = np.ones(len(body.vertices))
    for points, none, full in dark:
        distance = np.array([np.linalg.norm(points - vertex, axis=1).min() for vertex in body.vertices])
        keep = np.minimum(keep, np.clip((distance - none) / (full - none), 0.0, 1.0))
    return keep


def _cavities(head: HumanHead) -> NDArray[np.bool_]:
    """Vertices of the face, between the eyes and below, that see little of the sky: in nostrils, mouth and sockets."""
    body, vertices = head.body, head.body.vertices
    middles = [0.5 * (eye.vertices.min(axis=0) + eye.vertices.max(axis=0)) for eye in head.eyes]
    low = np.min(middles, axis=0) - (FACE_BESIDE_M, np.inf, FACE_BELOW_M)
    in_face = ((vertices > low) & (vertices < np.max(middles, axis=0) + (FACE_BESIDE_M, 0.0, 0.0))).all(axis=1)
    corners = vertices[body.faces]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals = np.zeros_like(vertices)
    for corner in range(4):
        np.add.at(normals, body.faces[:, corner], across)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    tree = BVHTree.FromPolygons(vertices.tolist(), body.faces.tolist())
    hidden = np.zeros(len(vertices), bool)
    for index in np.flatnonzero(in_face):
        cosine = SKY @ normals[index]
        start = Vector(vertices[index] + LIFT_M * normals[index])
        seen = [c > 0.0 and tree.ray_cast(start, Vector(ray))[0] is None for c, ray in zip(cosine, SKY, strict=True)]
        hidden[index] = cosine[seen].sum() < CAVITY_SEES * np.maximum(cosine, 0.0).sum()
    return hidden


def mask_glow(head: bpy.types.Object) -> None:
    """The person glows by the group, as a user sets it in the Material panel; the add-on is registered."""
    if MASK_GROUP in head.vertex_groups:
        for material in head.data.materials:
            material.skinglow.mask, material.skinglow.mask_group = "VERTEX_GROUP", MASK_GROUP


def _mask_group(body: bpy.types.Object) -> None:
    """The vertex group that masks the glow, from the attribute."""
    values = np.empty(len(body.data.vertices), np.float32)
    body.data.attributes["keep"].data.foreach_get("value", values)
    group = body.vertex_groups.new(name=MASK_GROUP)
    group.add(np.flatnonzero(values >= 1.0).tolist(), 1.0, "REPLACE")
    for index in np.flatnonzero((values > 0.0) & (values < 1.0)).tolist():
        group.add([index], float(values[index]), "REPLACE")
