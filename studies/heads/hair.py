"""Runs inside Blender: short hair, brows and lashes as thin triangles, which every version and engine draws alike."""

from __future__ import annotations

import bpy  # isort: skip  (importing it makes the others importable in the wheels)
import numpy as np
from numpy.typing import NDArray

from studies.heads.human_head import Array, Part

#: The hairline in the neutral head, seen from the side: y (the face looks along -y) and the lowest z of hair, meters.
HAIRLINE = np.array(
    [
        (-0.150, 0.806),
        (-0.128, 0.803),
        (-0.108, 0.791),
        (-0.092, 0.768),
        (-0.083, 0.742),
        (-0.076, 0.718),
        (-0.069, 0.709),
        (-0.062, 0.728),
        (-0.052, 0.742),
        (-0.030, 0.737),
        (-0.018, 0.715),
        (-0.008, 0.690),
        (0.010, 0.672),
        (0.035, 0.655),
        (0.120, 0.650),
    ]
)
HAIRLINE_SOFT_M = 0.007
#: Of the ears in the UV map: u and v from, to.
EARS_UV = ((0.815, 0.893, 0.603, 0.663), (0.815, 0.893, 0.303, 0.363))
#: One brow from the nose outward in the neutral head: x, z, half the height.
BROW = np.array([(0.010, 0.7478, 0.0030), (0.020, 0.7503, 0.0030), (0.036, 0.7535, 0.0023), (0.050, 0.7480, 0.0008)])
BROW_FRONT_Y = -0.115


def scalp(body: Part) -> Array:
    """How densely hair grows at each vertex, 0 to 1."""
    x, y, z = body.neutral.T
    above = z - np.interp(y, HAIRLINE[:, 0], HAIRLINE[:, 1])
    density = np.clip(above / HAIRLINE_SOFT_M + 0.5, 0.0, 1.0)
    u, v = body.uv[:, :, 0], body.uv[:, :, 1]
    for u0, u1, v0, v1 in EARS_UV:
        ear = ((u > u0) & (u < u1) & (v > v0) & (v < v1)).all(axis=1)
        density[np.unique(body.faces[ear])] = 0.0
    return density


def brows(body: Part) -> Array:
    """How near each vertex is to the middle of a brow: 1 in it, 0 from twice its height; negative never."""
    x, y, z = body.neutral.T
    across = np.abs(x)
    middle = np.interp(across, BROW[:, 0], BROW[:, 1])
    near = (across > BROW[0, 0] - 0.006) & (across < BROW[-1, 0] + 0.006) & (np.abs(z - middle) < 0.02)
    return (near & (y < BROW_FRONT_Y + 0.05)).astype(float)


class Surface:
    """The triangles of a fine mesh, to sample roots on."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        mesh.calc_loop_triangles()
        count = len(mesh.vertices)
        self.points = np.empty((count, 3), np.float32)
        self.normals = np.empty((count, 3), np.float32)
        self.triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
        mesh.vertices.foreach_get("co", self.points.ravel())
        mesh.vertices.foreach_get("normal", self.normals.ravel())
        mesh.loop_triangles.foreach_get("vertices", self.triangles.ravel())
        self.neutral = np.empty((count, 3), np.float32)
        mesh.attributes["neutral"].data.foreach_get("vector", self.neutral.ravel())
        self.density = {}
        for name in ("hair", "brow"):
            values = np.empty(count, np.float32)
            mesh.attributes[name].data.foreach_get("value", values)
            self.density[name] = values

    def sample(
        self, name: str, per_mm2: float, random: np.random.Generator
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        """Roots, normals, where they are in the neutral head, and the density there."""
        density = self.density[name]
        chosen = self.triangles[density[self.triangles].max(axis=1) > 0.0]
        a, b, c = (self.points[chosen[:, k]] for k in range(3))
        area = 0.5e6 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        count = random.poisson(area * per_mm2)
        corners = np.repeat(chosen, count, axis=0)
        u, v = random.random((2, len(corners)), np.float32)
        flip = u + v > 1.0
        u[flip], v[flip] = 1.0 - u[flip], 1.0 - v[flip]
        weights = np.stack([1.0 - u - v, u, v], axis=1)

        def mix(values: NDArray[np.float32]) -> NDArray[np.float32]:
            return np.einsum("nk,nk...->n...", weights, values[corners])

        dense = mix(density)
        kept = random.random(len(dense)) < dense
        return tuple(mix(v)[kept] for v in (self.points, self.normals, self.neutral)) + (dense[kept],)


Strands = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]  # points (n, k, 3), sides (n, 3), widths


def grow_scalp(surface: Surface) -> Strands:
    random = np.random.default_rng(1)
    roots, normals, neutral, density = surface.sample("hair", 1.5, random)
    sides = np.abs(neutral[:, 0]) > 0.045
    flow = np.column_stack([0.25 * roots[:, 0] / 0.08, np.full(len(roots), 1.0), np.where(sides, -0.9, -0.25)])
    length = (0.004 + 0.007 * np.clip((neutral[:, 2] - 0.70) / 0.1, 0.0, 1.0)) * density**0.7
    return _strands(roots, normals, flow, length, 0.35, 0.00009, random)


def grow_brows(surface: Surface) -> Strands:
    random = np.random.default_rng(2)
    roots, normals, neutral, _dense = surface.sample("brow", 3.5, random)
    across = np.abs(neutral[:, 0])
    middle, half = (np.interp(across, BROW[:, 0], BROW[:, k]) for k in (1, 2))
    off = np.abs(neutral[:, 2] - middle) / half
    inner = np.clip((across - BROW[0, 0]) / 0.006, 0.0, 1.0) * np.clip((BROW[-1, 0] - across) / 0.004, 0.0, 1.0)
    kept = (random.random(len(off)) < np.clip(1.6 * (1.0 - off), 0.0, 1.0) * (0.25 + 0.75 * inner)) & (inner > 0.0)
    roots, normals, across, neutral = roots[kept], normals[kept], across[kept], neutral[kept]
    out = np.sign(neutral[:, 0])
    rise = np.interp(across, [0.010, 0.022, 0.036, 0.050], [1.4, 0.5, 0.0, -0.6])
    flow = np.column_stack([out, np.full(len(out), 0.2), rise + 0.2 * random.standard_normal(len(out))])
    return _strands(roots, normals, flow, np.full(len(out), 0.0055), 0.12, 0.00007, random)


def grow_lashes(part: Part, eye: Part) -> Strands:
    """Lashes along a helper mesh, whose rows go from the lid, next to the eye, to the tips."""
    random = np.random.default_rng(3)
    center = 0.5 * (eye.vertices.min(axis=0) + eye.vertices.max(axis=0))
    off = np.linalg.norm(part.vertices - center, axis=1)
    near, far = (part.vertices[keep] for keep in (off <= np.quantile(off, 0.4), off >= np.quantile(off, 0.6)))
    upper = part.name.endswith("2")
    x = np.linspace(near[:, 0].min(), near[:, 0].max(), 120 if upper else 60)
    x = x + 0.0002 * random.standard_normal(len(x))
    roots, tips = (np.column_stack([x, *(_along(row, x, k) for k in (1, 2))]) for row in (near, far))
    tips[:, 0] += 0.25 * (x - center[0])  # they fan out
    offset = tips - roots
    length = (0.007 if upper else 0.0035) * (0.7 + 0.4 * random.random((len(x), 1)))
    offset *= length / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-9)
    up = np.array([0.0, 0.0, 0.0016 if upper else -0.0008])
    points = np.stack([roots, roots + 0.55 * offset - 0.3 * up, roots + offset + up], axis=1)
    side = np.tile([1.0, 0.0, 0.0], (len(x), 1))
    return points.astype(np.float32), side.astype(np.float32), np.full(len(x), 0.00006, np.float32)


def _along(row: Array, x: Array, axis: int) -> Array:
    order = np.argsort(row[:, 0])
    return np.interp(x, row[order, 0], row[order, axis])


def _strands(
    roots: NDArray[np.float32],
    normals: NDArray[np.float32],
    flow: Array,
    length: Array,
    lift: float,
    width: float,
    random: np.random.Generator,
) -> Strands:
    """Strands that leave along the flow on the surface, lifted off it, and bend down to it."""
    flow = flow + 0.25 * random.standard_normal(flow.shape)
    flow -= normals * np.einsum("nk,nk->n", flow, normals)[:, None]
    flow /= np.maximum(np.linalg.norm(flow, axis=1, keepdims=True), 1e-9)
    length = (length * (0.7 + 0.6 * random.random(len(length))))[:, None]
    raised = lift * (0.6 + 0.8 * random.random((len(roots), 1)))
    middle = roots + 0.5 * length * (flow + raised * normals)
    tip = roots + length * (flow + 0.6 * raised * normals)
    side = np.cross(flow, normals + 0.7 * random.standard_normal(normals.shape))
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)
    points = np.stack([roots - 0.0003 * normals, middle, tip], axis=1)
    return points.astype(np.float32), side.astype(np.float32), np.full(len(roots), width, np.float32)


def mesh_of(name: str, groups: list[Strands]) -> bpy.types.Object:
    """All strands as one mesh: three triangles each, that taper to a tip."""
    points = np.concatenate([g[0] for g in groups])
    across = np.concatenate([g[1] * g[2][:, None] for g in groups])
    count = len(points)
    vertices = np.stack(
        [
            points[:, 0] - across,
            points[:, 0] + across,
            points[:, 1] - 0.8 * across,
            points[:, 1] + 0.8 * across,
            points[:, 2],
        ],
        axis=1,
    )
    pattern = np.array([(0, 1, 2), (1, 3, 2), (2, 3, 4)])
    triangles = (5 * np.arange(count)[:, None, None] + pattern).reshape(-1)
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(5 * count)
    mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    mesh.loops.add(len(triangles))
    mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32))
    mesh.polygons.add(3 * count)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 9 * count, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(3 * count, 3, np.int32))
    mesh.update(calc_edges=True)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made
