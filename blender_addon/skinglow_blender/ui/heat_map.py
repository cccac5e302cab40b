# SPDX-License-Identifier: GPL-3.0-or-later
"""Thickness as colors over the skins in the 3D Viewport, with a legend in mm."""

from typing import Any

import blf
import bpy
import gpu
import numpy as np
from bpy.props import BoolProperty
from gpu_extras.batch import batch_for_shader

from ..errors import SkinError, core
from ..identity import key_of
from ..live.guard import faults_shown, guarded
from ..read.measured_size import scale_since_measured
from ..read.mesh_reading import evaluated_mesh, triangles_of, vertices_of
from ..thickness import thickness_attribute

#: Fraction of its size by which a mesh is drawn larger, along its normals: in front of its own surface.
LIFT = 1e-3
#: The legend, in pixels at Blender's usual resolution: width and height of the bar, and its distance from the corner.
BAR = (14, 160)
CORNER = (24, 60)
STEPS = 48

_handles: list[tuple[Any, str]] = []
#: By skin: what its colors were made from, and the batch that is drawn.
_batches: dict[str, tuple[tuple, Any]] = {}


def shown_skins(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The skins that the heat map covers in a view: those selected, and the active one; none without overlays."""
    view, active = context.space_data, context.object
    if not view.overlay.show_overlays:
        return []
    chosen = [*context.selected_objects, *([active] if active is not None else [])]
    skins = [o for o in dict.fromkeys(chosen) if o.type == "MESH" and o.skinglow.enabled]
    # The second leaves out what is not in the view's local view or local collections.
    return [o for o in skins if o.visible_get() and o.visible_in_viewport_get(view)]


def limit_mm(skins: list[bpy.types.Object]) -> float:
    """The thickness at the dark end of the colors: the last of the skins' lookups."""
    return max((obj.skinglow.max_thickness_mm for obj in skins), default=1.0)


def colored_triangles(obj: bpy.types.Object, limit: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions (n, 3) and colors (n, 4) of an evaluated skin's vertices, object space, and its triangles (m, 3)."""
    with evaluated_mesh(obj) as mesh:
        thickness, known = thickness_attribute.read(mesh)
        positions, triangles = vertices_of(mesh), triangles_of(mesh).copy()
        normals = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("normal", normals)
    world_size = abs(obj.matrix_world.to_3x3().determinant()) ** (1.0 / 3.0)
    values = np.where(known, thickness * scale_since_measured(obj.original.data, world_size), -1.0)
    colors = np.ones((len(values), 4), np.float32)
    colors[:, :3] = core().thickness_colors(values, limit)
    size = float(np.ptp(positions, axis=0).max()) if len(positions) else 0.0
    return positions + LIFT * size * normals.reshape(-1, 3), colors, triangles


@faults_shown()
def draw_skins() -> None:
    """Draws the colors of the skins; called by Blender for each view."""
    context = bpy.context
    if not context.window_manager.skinglow_heat_map or context.mode != "OBJECT":
        return
    skins = shown_skins(context)
    limit = limit_mm(skins)
    depsgraph = context.view_layer.depsgraph
    shader = _shader()
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(True)
    try:
        for obj in skins:
            evaluated = obj.evaluated_get(depsgraph)
            key = (limit, tuple(map(tuple, evaluated.matrix_world.to_3x3())))
            known = _batches.get(key_of(obj))
            if known is None or known[0] != key:
                try:
                    positions, colors, triangles = colored_triangles(evaluated, limit)
                except SkinError:  # without the core
                    continue
                fields = {"pos": positions, "color": colors}
                known = _batches[key_of(obj)] = (key, batch_for_shader(shader, "TRIS", fields, indices=triangles))
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(evaluated.matrix_world)
                shader.bind()
                known[1].draw(shader)
    finally:
        gpu.state.depth_mask_set(False)
        gpu.state.depth_test_set("NONE")


@faults_shown()
def draw_legend() -> None:
    """Draws what the colors mean, in the lower left corner."""
    context = bpy.context
    skins = shown_skins(context) if context.window_manager.skinglow_heat_map else []
    if not skins or context.mode != "OBJECT":
        return
    scale = context.preferences.system.ui_scale
    limit = limit_mm(skins)
    (width, height), (x, y) = (tuple(scale * n for n in pair) for pair in (BAR, CORNER))
    left = scale * 60 + x if context.area.spaces.active.show_region_toolbar else x
    levels = np.linspace(0.0, 1.0, STEPS + 1)
    rows = [[(left, y + height * t), (left + width, y + height * t)] for t in levels.tolist()]
    colors = np.ones((2 * (STEPS + 1), 4), np.float32)
    colors[:, :3] = np.repeat(core().thickness_colors(levels * limit, limit), 2, axis=0)
    low = np.arange(STEPS)[:, None] * 2
    triangles = np.concatenate([low + (0, 1, 2), low + (1, 3, 2)]).astype(np.int32)
    positions = [(px, py, 0.0) for row in rows for px, py in row]
    shader = _shader()
    shader.bind()
    batch_for_shader(shader, "TRIS", {"pos": positions, "color": colors}, indices=triangles).draw(shader)
    gray = np.ones((4, 4), np.float32)
    gray[:, :3] = core().thickness_colors([-1.0], limit)
    below = y - 1.8 * width
    corners = [(left, below, 0), (left + width, below, 0), (left, below + width, 0), (left + width, below + width, 0)]
    box = batch_for_shader(shader, "TRIS", {"pos": corners, "color": gray}, indices=((0, 1, 2), (1, 3, 2)))
    box.draw(shader)
    for fraction, text in ((0.0, "0 mm"), (0.5, f"{limit / 2:.3g}"), (1.0, f"{limit:.3g} or more")):
        _text(left + 1.5 * width, y + height * fraction - 4 * scale, text, scale)
    _text(left + 1.5 * width, below + 2 * scale, "not known", scale)
    _text(left, y + height + 10 * scale, "Thickness", scale)


def _text(x: float, y: float, text: str, scale: float) -> None:
    size = 11 * scale
    if bpy.app.version < (4, 0, 0):
        blf.size(0, int(size), 72)
    else:
        blf.size(0, size)
    blf.color(0, 1.0, 1.0, 1.0, 1.0)
    blf.position(0, x, y, 0.0)
    blf.draw(0, text)


def _shader() -> Any:  # noqa: ANN401  a GPUShader
    return gpu.shader.from_builtin("SMOOTH_COLOR" if bpy.app.version >= (4, 0, 0) else "3D_SMOOTH_COLOR")


@guarded
def _on_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None) -> None:
    """Drops the colors of what changed its shape."""
    if not _batches:
        return
    changed = {key_of(u.id) for u in depsgraph.updates if u.is_updated_geometry} if depsgraph else None
    for name in list(_batches):
        if changed is None or name in changed:
            del _batches[name]


@guarded
def _forget(_first: object, _second: object) -> None:
    _batches.clear()


def _toggled(manager: bpy.types.WindowManager, _context: bpy.types.Context) -> None:
    _batches.clear()
    _stop_drawing()
    if manager.skinglow_heat_map and not bpy.app.background:
        for draw, kind in ((draw_skins, "POST_VIEW"), (draw_legend, "POST_PIXEL")):
            _handles.append((bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", kind), "WINDOW"))
        for event, handler in HANDLERS:
            getattr(bpy.app.handlers, event).append(handler)
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _stop_drawing() -> None:
    for handle, region in _handles:
        bpy.types.SpaceView3D.draw_handler_remove(handle, region)
    _handles.clear()
    for event, handler in HANDLERS:
        handlers = getattr(bpy.app.handlers, event)
        if handler in handlers:
            handlers.remove(handler)


HANDLERS = (
    ("depsgraph_update_post", _on_change),
    ("frame_change_post", _forget),
    ("undo_post", _forget),
    ("redo_post", _forget),
    ("load_post", _forget),
)


def register() -> None:
    """Adds the switch, which draws nothing until it is on."""
    bpy.types.WindowManager.skinglow_heat_map = BoolProperty(
        name="Show Thickness",
        default=False,
        update=_toggled,
        options={"SKIP_SAVE"},
        description="Color the selected skins by their thickness in the 3D Viewport, with a legend in mm",
    )


def unregister() -> None:
    """Removes the switch and what it draws."""
    _stop_drawing()
    _batches.clear()
    del bpy.types.WindowManager.skinglow_heat_map
