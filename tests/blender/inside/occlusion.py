"""Other objects between lights and a skin's far side: darkened, lit again, and told."""

import math

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.live import handlers
from skinglow_blender.session import SESSION

from inside.light_units import rendered_irradiance, stage
from inside.scenes import add_light, depsgraph, link, patch, render_settings

THIN = [1.0, 1.0, 1.0, 1.0]


def head(name="Head", radius=0.1, location=(0.0, 0.0, 0.0)):
    """A ball of skin, as thin everywhere as an ear."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=radius, location=location)
    obj = bpy.context.object
    obj.name = name
    sb.make_skin(obj, thickness=np.full(len(obj.data.vertices), 3.0), mode="physical")
    return obj


def wall(name="Wall", size=1.0, location=(0.0, 0.0, 0.5)):
    return patch(name, size=size, location=location)


def point_light(name="Key", location=(0.0, 0.0, 1.0), **settings):
    obj = add_light(name, energy=40.0, location=location, **settings)
    obj.data.shadow_soft_size = 0.0
    return obj


def brightness(obj):
    return float(sb.lut(obj, depsgraph()).sum())


def row_of(obj, name="Key"):
    return next(row for row in sb.light_report(obj, depsgraph()) if row["name"] == name)


def switch(on=True):
    bpy.context.scene.skinglow.occlusion = on


def check_off_by_default_and_costs_nothing(_work):
    point_light()
    obj = head()
    free = brightness(obj)
    wall()
    assert brightness(obj) == free > 0.0
    assert not SESSION.occluders
    row = row_of(obj)
    assert (row["visible"], row["reason"], row["note"]) == (1.0, "", "")


def check_wall_darkens_and_moves_away(_work):
    point_light()
    obj = head()
    free = brightness(obj)
    switch()
    # The skin's own body does not shadow itself, though half of its far sides lie behind it.
    assert brightness(obj) == free
    between = wall()
    assert brightness(obj) == 0.0
    row = row_of(obj)
    assert (row["visible"], row["reason"], row["share"]) == (0.0, "occluded", 0.0)
    assert not row["weight"].any()
    between.location.x = 5.0
    assert brightness(obj) == free
    assert row_of(obj)["reason"] == ""
    between.location = (0.0, 0.0, 1.5)  # behind the light
    assert brightness(obj) == free
    between.location = (0.0, 0.0, 0.5)
    assert brightness(obj) == 0.0
    switch(False)
    assert brightness(obj) == free
    switch()
    assert brightness(obj) == 0.0
    bpy.data.objects.remove(between)
    assert brightness(obj) == free


def check_why_it_was_rebuilt(_work):
    point_light()
    obj = head()
    switch()
    between = wall(location=(5.0, 0.0, 0.5))
    depsgraph()
    between.location.x = 0.0
    handlers.unregister()
    SESSION.forget_tables()
    sb.update(depsgraph())
    between.location.x = 5.0
    (rebuilt,) = sb.update(depsgraph())
    handlers.register()
    assert rebuilt.why == "light 'Key': visible fraction", rebuilt.why
    assert sb.update(depsgraph()) == []
    assert obj.name == rebuilt.skin


def check_moving_a_light_only_traces(_work):
    key = point_light()
    obj = head()
    switch()
    between = wall()
    assert brightness(obj) == 0.0
    scene = SESSION.occluders["VIEWPORT"].scene
    key.location = (0.0, 1.0, 0.0)
    assert brightness(obj) > 0.0
    assert SESSION.occluders["VIEWPORT"].scene is scene
    between.location.z = 0.6
    depsgraph()
    assert SESSION.occluders["VIEWPORT"].scene is not scene


def check_half_covered_area_light_is_about_half(_work):
    key = add_light("Key", kind="AREA", energy=40.0, location=(0.0, 0.0, 1.0))
    key.data.shape, key.data.size = "DISK", 0.5
    obj = head(radius=0.01)
    free = brightness(obj)
    switch()
    between = wall(size=4.0, location=(2.0, 0.0, 0.5))  # an edge at x = 0
    half = brightness(obj) / free
    assert abs(half - 0.5) < 0.01, half
    row = row_of(obj)
    assert abs(row["visible"] - half) < 1e-3
    assert row["reason"] == "" and "let" in row["note"], row
    between.location.y = 4.0
    assert brightness(obj) == free
    return half


def check_paper_is_kept_to_the_letter(_work):
    point_light()
    obj = head()
    obj.skinglow.mode = "PAPER"
    before = sb.lut(obj, depsgraph())
    switch()
    wall()
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)
    assert row_of(obj)["visible"] == 1.0


def check_thick_places_do_not_count(_work):
    """Half of the skin is too thick for light; only the thin half asks what it sees."""
    point_light(location=(1.0, 0.0, 0.0))
    obj = head()
    x = np.array([v.co.x for v in obj.data.vertices])
    sb.make_skin(obj, thickness=np.where(x > 0.0, 3.0, 80.0))
    switch()
    wall(size=0.09, location=(0.25, 0.0, 0.0)).rotation_euler = (0.0, math.pi / 2, 0.0)
    some = row_of(obj)["visible"]
    sb.make_skin(obj, thickness=np.where(x > 0.0, 80.0, 3.0))
    others = row_of(obj)["visible"]
    assert some != others, (some, others)


def check_faults_keep_the_last_lookup(_work):
    point_light()
    obj = head()
    switch()
    wall(location=(5.0, 0.0, 0.5))
    before = sb.lut(obj, depsgraph())
    bad = patch("Bad", size=1.0)
    bad.data.vertices.foreach_set("co", [float("nan")] * 12)
    bad.data.update()
    depsgraph()
    try:
        sb.update(depsgraph())
    except sb.SkinError as error:
        assert "Head" in str(error) and "vertices" in str(error), error
    else:
        raise AssertionError("a wall of no numbers was taken")
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)
    bpy.data.objects.remove(bad)
    sb.update(depsgraph())
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)


def check_renders_have_occluders_of_their_own(work):
    """A wall that only renders is seen by the render's lookup, frame by frame, and not by the viewport's."""
    point_light()
    obj = head()
    switch()
    between = wall()
    between.hide_viewport = True
    free = brightness(obj)
    assert free > 0.0
    for frame, x in ((1, 5.0), (2, 0.0), (3, 5.0)):
        between.location.x = x
        between.keyframe_insert("location", frame=frame)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    link(camera)
    bpy.context.scene.camera = camera
    scene = render_settings(4, 4)
    found = {}

    def note(_scene, graph):
        if graph.mode == "RENDER":
            found[_scene.frame_current] = float(sb.lut(obj, graph).sum())

    bpy.app.handlers.frame_change_post.append(note)
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(work / "frame")
    bpy.ops.render.render(animation=True)
    assert set(found) == {1, 2, 3}, found
    assert found[2] == 0.0 < found[1], found
    np.testing.assert_allclose([found[1], found[3]], free, rtol=1e-6)
    assert "RENDER" not in SESSION.occluders
    assert brightness(obj) == free


def check_against_cycles(work):
    """A white Lambert plane partly in a wall's shadow, each kind of light: Cycles' darkening is the visible share."""
    scene = stage()
    # Over the edge of a wall between plane and light, out of the camera's way.
    between = wall(size=4.0, location=(2.1, 0.0, 1.0))
    between.visible_camera = False
    graph = depsgraph()
    arrays = between.evaluated_get(graph).data
    matrix = np.array(between.matrix_world)
    corners = np.array([v.co for v in arrays.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]
    scene_of_rays = sg.Occluders([(corners, [[0, 1, 2], [0, 2, 3]])])
    cases = {
        "area disk": ("AREA", {"shape": "DISK", "size": 1.0}),
        "area rectangle": ("AREA", {"shape": "RECTANGLE", "size": 0.8, "size_y": 0.4}),
        "point": ("POINT", {"shadow_soft_size": 0.4}),
        "sun": ("SUN", {"angle": 0.5}),
    }
    result = {}
    for name, (kind, fields) in cases.items():
        obj = add_light(kind=kind, energy=100.0, location=(0.0, 0.0, 2.0))
        obj.visible_camera = False
        for field, value in fields.items():
            setattr(obj.data, field, value)
        between.hide_render = True
        free = rendered_irradiance(work, scene)[0]
        between.hide_render = False
        shadowed = rendered_irradiance(work, scene)[0]
        read = occlusion_light(obj)
        share = scene_of_rays.visible_fraction([read], np.zeros((1, 3)), [[0.0, 0.0, 1.0]], samples=4096).mean[0]
        bpy.data.objects.remove(obj)
        assert 0.2 < share < 0.95, (name, share)
        result[name] = (shadowed / free, share)
        assert abs(shadowed / free - share) < 0.005, result
    return {name: [float(a), float(b)] for name, (a, b) in result.items()}


def occlusion_light(obj):
    from skinglow_blender.read import scene_lights

    evaluated = obj.evaluated_get(depsgraph())
    return scene_lights.make_light(scene_lights.read_light(evaluated, evaluated.matrix_world, obj.name))
