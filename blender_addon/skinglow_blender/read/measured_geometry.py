# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh whose thickness is measured: as it is shown in the viewport, with modifiers, shape keys and pose.

The thickness is stored on the mesh's own vertices, and modifiers pass it on to theirs. So each own vertex needs the
vertex that it became.
"""

import hashlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils.kdtree import KDTree

from ..errors import SkinError
from ..setting_values import as_typed
from .mesh_reading import evaluated_mesh, triangles_of, vertices_of
from .scene_reading import MM_PER_METER

#: Modifiers that make vertices anew. All others move those they were given, or add some behind them.
REBUILDING = frozenset(
    "BEVEL BOOLEAN BUILD DECIMATE EDGE_SPLIT EXPLODE FLUID MASK MESH_SEQUENCE_CACHE NODES OCEAN REMESH SCREW SKIN "
    "VOLUME_TO_MESH WELD WIREFRAME".split()
)
#: Modifiers that move no vertex: shading, weights, UV maps, hair and physics.
MOVING_NOTHING = frozenset(
    "COLLISION DATA_TRANSFER NORMAL_EDIT PARTICLE_SYSTEM UV_PROJECT UV_WARP VERTEX_WEIGHT_EDIT VERTEX_WEIGHT_MIX "
    "VERTEX_WEIGHT_PROXIMITY WEIGHTED_NORMAL".split()
)
#: Geometry nodes that pass geometry on with its vertices where they are: *Smooth by Angle* consists of these.
PASSING_ON = frozenset(
    "GeometryNodeRemoveAttribute GeometryNodeSetMaterial GeometryNodeSetMaterialIndex GeometryNodeSetShadeSmooth "
    "GeometryNodeStoreNamedAttribute GeometryNodeSwitch NodeGroupInput NodeGroupOutput NodeReroute".split()
)


def unit_mm(obj: bpy.types.Object, scene: bpy.types.Scene) -> float:
    """Millimeters per scene unit: the skin's own setting, or the scene's unit scale."""
    own = as_typed(obj.skinglow.unit_mm)
    return own if own > 0.0 else MM_PER_METER * scene.unit_settings.scale_length


class Geometry(NamedTuple):
    """The input of a thickness measurement."""

    vertices: np.ndarray  #: (n, 3) float64, world, scene units
    triangles: np.ndarray  #: (m, 3) int32, counter-clockwise seen from outside
    shown_as: np.ndarray | None  #: (v,) index in `vertices` of each vertex of the mesh itself; None: they are the same
    unit_mm: float
    rays: int
    min_sky_visibility: float  #: min fraction of the sky visible from a far side that lets light in

    def digest(self) -> str:
        """A digest of everything the thickness depends on."""
        state = hashlib.sha256(self.vertices.tobytes())
        state.update(self.triangles.tobytes())
        if self.shown_as is not None:
            state.update(self.shown_as.tobytes())
        state.update(f"{self.unit_mm} {self.rays} {self.min_sky_visibility}".encode())
        return state.hexdigest()


def read_geometry(obj: bpy.types.Object, scene: bpy.types.Scene) -> Geometry:
    """The mesh as the viewport shows it, in world orientation and scale."""
    check_mesh(obj)
    with evaluated_mesh(obj.evaluated_get(bpy.context.evaluated_depsgraph_get())) as mesh:
        vertices = vertices_of(mesh)
        triangles = triangles_of(mesh)
    if not len(triangles):
        raise SkinError(f"'{obj.name}' has no faces left behind its modifiers: measure it where they show some")
    shown_as = _shown_as(obj, vertices)
    # Without the translation, which does not matter and would cost precision.
    world = vertices @ np.array(obj.matrix_world, np.float64)[:3, :3].T
    if obj.matrix_world.determinant() < 0.0:
        triangles = triangles[:, ::-1]  # mirroring reverses the winding order
    return Geometry(
        world,
        np.ascontiguousarray(triangles),
        shown_as,
        unit_mm(obj, scene),
        obj.skinglow.rays,
        obj.skinglow.min_openness,
    )


def mesh_digest(obj: bpy.types.Object) -> str:
    """A digest of a mesh without its modifiers, and of the kinds of those that may move its vertices."""
    return _digest_with_modifiers(_digest_of(obj.data), obj, "show_viewport")


def mesh_digests(objects: Sequence[bpy.types.Object]) -> list[set[str]]:
    """The digests of objects that share one mesh: with the modifiers that the viewport and those that a render shows.

    Who hides a modifier in the viewport to work faster wants the thickness that was measured with it.
    """
    mesh = _digest_of(objects[0].data)
    return [{_digest_with_modifiers(mesh, o, shown) for shown in ("show_viewport", "show_render")} for o in objects]


def _digest_of(mesh: bpy.types.Mesh) -> Any:  # noqa: ANN401  hashlib names no type
    state = hashlib.sha256(vertices_of(mesh).tobytes())
    state.update(triangles_of(mesh).tobytes())
    return state


def _digest_with_modifiers(mesh: Any, obj: bpy.types.Object, shown: str) -> str:  # noqa: ANN401
    state = mesh.copy()
    state.update(" ".join(m.type for m in obj.modifiers if getattr(m, shown) and not _moves_nothing(m)).encode())
    return state.hexdigest()


def _moves_nothing(modifier: bpy.types.Modifier) -> bool:
    return modifier.type in MOVING_NOTHING or (modifier.type == "NODES" and _passes_on(modifier.node_group))


def _passes_on(tree: bpy.types.NodeTree | None) -> bool:
    """Whether the vertices stay where they are, judged by which nodes there are."""
    for node in tree.nodes if tree is not None else ():
        if not any(socket.type == "GEOMETRY" for socket in node.outputs):
            continue
        is_group = node.bl_idname == "GeometryNodeGroup"
        if not (_passes_on(node.node_tree) if is_group else node.bl_idname in PASSING_ON):
            return False
    return True


def _shown_as(obj: bpy.types.Object, shown: np.ndarray) -> np.ndarray | None:
    """The index of each of a mesh's own vertices among those shown; None: they are the same."""
    count = len(obj.data.vertices)
    rebuilding = {m.type for m in obj.modifiers if m.show_viewport and _rebuilds(m)}
    if len(shown) == count and rebuilding <= {"NODES"}:
        return None  # nodes mostly smooth, or move what is there
    if len(shown) > count and not rebuilding:
        return np.arange(count)
    tree = KDTree(len(shown))
    for i, position in enumerate(shown.tolist()):
        tree.insert(position, i)
    tree.balance()
    return np.array([tree.find(position)[1] for position in vertices_of(obj.data).tolist()], np.int64)


def _rebuilds(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier may change the order of the vertices that it was given."""
    if modifier.type == "MIRROR":
        return any(modifier.use_bisect_axis)
    if modifier.type == "SOLIDIFY":
        return modifier.solidify_mode == "NON_MANIFOLD"
    return modifier.type in REBUILDING


def check_mesh(obj: bpy.types.Object) -> None:
    """Raises SkinError for an object that cannot be a skin."""
    if obj is None or obj.type != "MESH":
        raise SkinError(f"'{getattr(obj, 'name', obj)}' is not a mesh: select the mesh to make glow")
    if not obj.data.polygons:
        raise SkinError(f"'{obj.name}' has no faces, so no light can pass through it")
    if obj.mode == "EDIT":
        raise SkinError(f"'{obj.name}' is in Edit Mode: leave it (Tab) first")
    scales = [column.to_3d().length for column in obj.matrix_world.col[:3]]
    if min(scales) == 0.0 or obj.matrix_world.to_3x3().determinant() == 0.0:
        raise SkinError(f"'{obj.name}' has scale 0 along an axis, so it has no thickness: change its scale")
