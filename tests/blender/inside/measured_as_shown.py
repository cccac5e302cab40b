"""Thickness is that of the mesh as it is shown, and grows with it: modifiers, shape keys, pose, applied scales."""

import bpy
import numpy as np
import skinglow_blender as sb
from mathutils import Matrix
from skinglow_blender.read import measured_geometry
from skinglow_blender.read.scene_reading import ROW_PROPERTY
from skinglow_blender.thickness import thickness_attribute

from inside.scenes import depsgraph, link

SIDE, STEPS = 0.04, 8


def plate(bottom=-0.001, top=0.001, closed=True):
    """A plate of SIDE meters, in STEPS squares a side, from one height to the other; open: its upper side alone."""
    ticks = np.linspace(-SIDE / 2, SIDE / 2, STEPS + 1)
    heights = (bottom, top) if closed else (top,)
    vertices = [(x, y, z) for z in heights for y in ticks for x in ticks]
    n, faces = STEPS + 1, []
    for layer in range(len(heights)):
        for j in range(STEPS):
            for i in range(STEPS):
                a = layer * n * n + j * n + i
                face = (a, a + 1, a + n + 1, a + n)
                faces.append(face if layer == len(heights) - 1 else face[::-1])
    if closed:
        rim = [*range(STEPS), *range(STEPS, n * n - 1, n), *range(n * n - 1, n * n - n, -1), *range(n * n - n, 0, -n)]
        for a, b in zip(rim, rim[1:] + rim[:1], strict=True):
            faces.append((a, b, b + n * n, a + n * n))
    mesh = bpy.data.meshes.new("Plate")
    mesh.from_pydata(vertices, [], faces)
    return link(bpy.data.objects.new("Plate", mesh))


def middle(obj):
    """The vertices of the upper side away from its rim."""
    positions = np.array([v.co for v in obj.data.vertices])
    return (np.abs(positions[:, :2]).max(axis=1) < SIDE / 4) & (positions[:, 2] > 0.0)


def measured(obj):
    """Median thickness in the middle of the upper side, mm."""
    sb.make_skin(obj)
    values, known = thickness_attribute.read(obj.data)
    assert known.all() and len(values) == len(obj.data.vertices)
    return float(np.median(values[middle(obj)]))


def check_without_modifiers(_work):
    assert abs(measured(plate()) - 2.0) < 1e-4


def check_modifiers_that_add_vertices(_work):
    half = plate(closed=False)
    mirror = half.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis = (False, False, True)
    mirror.use_mirror_merge = False
    assert abs(measured(half) - 2.0) < 1e-3
    sheet = plate(closed=False)
    sheet.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.002
    assert abs(measured(sheet) - 2.0) < 1e-3
    smooth = plate()
    smooth.modifiers.new("Subdivision", "SUBSURF").levels = 2
    assert abs(measured(smooth) - 2.0) < 0.02
    row = plate()
    row.modifiers.new("Array", "ARRAY").count = 3
    assert abs(measured(row) - 2.0) < 1e-3


def check_modifiers_keep_the_order_that_is_relied_on(_work):
    """Each own vertex is near the one that it is taken to be shown as."""
    for kind, settings in (
        ("MIRROR", {"use_axis": (True, False, True)}),
        ("SOLIDIFY", {"thickness": 1e-4}),
        ("SOLIDIFY", {"thickness": 1e-4, "solidify_mode": "NON_MANIFOLD"}),
        ("SUBSURF", {"levels": 2}),
        ("ARRAY", {"count": 2}),
        ("MIRROR", {"use_bisect_axis": (True, False, False)}),
        ("DECIMATE", {"ratio": 0.6}),
        ("BEVEL", {"width": 1e-4}),
        ("TRIANGULATE", {}),
        ("EDGE_SPLIT", {}),
    ):
        obj = plate()
        modifier = obj.modifiers.new("Tested", kind)
        for name, value in settings.items():
            setattr(modifier, name, value)
        depsgraph()
        geometry = measured_geometry.read_geometry(obj, bpy.context.scene)
        own = np.array([v.co for v in obj.data.vertices])
        shown = geometry.vertices if geometry.shown_as is None else geometry.vertices[geometry.shown_as]
        near = np.linalg.norm(shown - own, axis=1)
        # Decimation leaves neighbors, bisecting half of the mesh.
        step = SIDE / STEPS
        limit = SIDE if "use_bisect_axis" in settings else 1.5 * step if kind == "DECIMATE" else 0.4 * step
        assert near.max() < limit and np.median(near) < step, (kind, settings, near.max())


def check_shape_keys_and_pose(_work):
    obj = plate()
    obj.shape_key_add(name="Basis")
    thick = obj.shape_key_add(name="Thick")
    for point in thick.data:
        point.co.z *= 2.0
    thick.value = 0.0
    depsgraph()
    assert abs(measured(obj) - 2.0) < 1e-3
    thick.value = 1.0
    depsgraph()
    assert abs(measured(obj) - 4.0) < 1e-3
    bent = plate()
    cast = bent.modifiers.new("Scaled", "SIMPLE_DEFORM")
    cast.deform_method, cast.factor = "STRETCH", 0.0
    assert abs(measured(bent) - 2.0) < 1e-3


def geometry_nodes(obj, *kinds):
    """A modifier of these nodes, one behind the other."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        if hasattr(tree, "interface"):
            tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
        else:
            (tree.inputs if in_out == "INPUT" else tree.outputs).new("NodeSocketGeometry", "Geometry")
    before = tree.nodes.new("NodeGroupInput")
    for kind in (*kinds, "NodeGroupOutput"):
        node = tree.nodes.new(kind)
        tree.links.new(before.outputs[0], node.inputs[0])
        before = node
    obj.modifiers.new("Nodes", "NODES").node_group = tree


def check_smooth_shading_by_nodes_is_no_edit(_work):
    """*Shade Auto Smooth* adds geometry nodes, which move nothing; others may."""
    obj = plate()
    sb.make_skin(obj)
    geometry_nodes(obj, "GeometryNodeSetShadeSmooth", "GeometryNodeStoreNamedAttribute")
    depsgraph()
    assert sb.health(obj) == []
    if bpy.app.version >= (5, 0):  # 4.5 loads its asset in a window alone, 3.4 has none
        bpy.context.view_layer.objects.active = obj
        obj.select_set(True)
        assert bpy.ops.object.shade_auto_smooth() == {"FINISHED"}
        depsgraph()
        assert [m.type for m in obj.modifiers] == ["NODES", "NODES"] and sb.health(obj) == []
    geometry_nodes(obj, "GeometryNodeSetPosition")
    depsgraph()
    (fault,) = sb.health(obj)
    assert "modifiers were edited" in fault.what


def check_posed_armature(_work):
    """As it is posed, or at rest where the armature shows that."""
    armature = link(bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig")))
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.0, 0.0, 0.0), (0.0, 0.0, SIDE)
    bpy.ops.object.mode_set(mode="OBJECT")
    obj = plate()
    obj.vertex_groups.new(name="Bone").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
    obj.modifiers.new("Rig", "ARMATURE").object = armature
    assert abs(measured(obj) - 2.0) < 1e-3
    # Along the bone, which is upright.
    armature.pose.bones["Bone"].scale = (1.0, 2.0, 1.0)
    depsgraph()
    assert "Bone" in armature.pose.bones and abs(measured_anew(obj) - 4.0) < 1e-3
    armature.data.pose_position = "REST"
    depsgraph()
    assert abs(measured_anew(obj) - 2.0) < 1e-3


def measured_anew(obj):
    """The same, measured although nothing of the mesh itself was edited."""
    thickness_attribute.remove(obj.data)
    return measured(obj)


def shown_thickness(obj):
    """Median thickness in the middle as the material reads it, mm."""
    depsgraph()
    values, _known = thickness_attribute.read(obj.data)
    texels_per_mm = obj[ROW_PROPERTY][0]
    return float(np.median(values[middle(obj)])) * texels_per_mm / (255.0 / 12.0)


def check_applied_scale(_work):
    """The object's scale, applied; the mesh scaled in Edit Mode; rotated; then measured again: the same thickness."""
    obj = plate()
    obj.scale = (2.0, 2.0, 2.0)
    depsgraph()
    assert abs(measured(obj) - 4.0) < 1e-3 and abs(shown_thickness(obj) - 4.0) < 1e-3
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.ops.object.transform_apply(scale=True)
    assert abs(shown_thickness(obj) - 4.0) < 1e-3
    obj.rotation_euler = (0.3, 0.2, 0.1)
    bpy.ops.object.transform_apply(rotation=True)
    assert abs(shown_thickness(obj) - 4.0) < 1e-3
    obj.data.transform(Matrix.Scale(0.5, 4))
    obj.data.update()
    assert abs(shown_thickness(obj) - 2.0) < 1e-3
    obj.scale = (3.0, 3.0, 3.0)
    assert abs(shown_thickness(obj) - 6.0) < 1e-3
    before = obj.data["skinglow_measured"]
    sb.make_skin(obj)
    assert obj.data["skinglow_measured"] != before and abs(shown_thickness(obj) - 6.0) < 1e-3


def check_applied_uneven_scale_and_location(_work):
    """What is shown is as before, to the eye and in the thickness; a mirrored one is told, and Repair mends that."""

    def thickest(obj):
        depsgraph()
        return thickness_attribute.read(obj.data)[0].max() * obj[ROW_PROPERTY][0]

    for scale, rotation, location in (
        ((1.0, 2.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        ((1.0, 1.0, 3.0), (0.3, 0.2, 0.1), (1.0, 2.0, 3.0)),
        ((0.5, 2.0, 1.0), (0.0, 0.0, 0.0), (1.0, 2.0, 3.0)),
        ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 2.0, 3.0)),
        ((2.0, -1.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=8)
        obj = bpy.context.object
        obj.skinglow.unit_mm = 10.0
        obj.scale, obj.rotation_euler, obj.location = scale, rotation, location
        depsgraph()
        sb.make_skin(obj, mode="paper")
        before = thickest(obj)
        bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
        depsgraph()
        if min(scale) < 0.0:
            assert bpy.ops.skinglow.repair() == {"FINISHED"}
        assert sb.health(obj) == [], (scale, sb.health(obj))
        near = 0.02 if min(scale) < 0.0 else 1e-5
        np.testing.assert_allclose(thickest(obj), before, rtol=near)
        obj.scale = (2.0, 2.0, 2.0)
        depsgraph()
        assert sb.health(obj) == []
        np.testing.assert_allclose(thickest(obj), 2.0 * before, rtol=near)
        obj.scale = (1.0, 1.5, 1.0)
        depsgraph()
        assert "scaled unevenly" in sb.health(obj)[0].what


def check_other_edits_scale_nothing(_work):
    obj = plate()
    measured(obj)
    before = shown_thickness(obj)
    for vertex in obj.data.vertices:
        vertex.co.x *= 1.5
    obj.data.update()
    assert shown_thickness(obj) == before
