"""The light rigs of a batch: what shines in their pictures, and that nothing is left of them."""

import warnings
from pathlib import Path

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb

from inside.bad_input import refused
from inside.batch_studio import (
    DATA,
    RIGS,
    assert_same,
    color_at,
    everything,
    expected,
    manifest_of,
    names,
    shown_in,
    studio,
)
from inside.scenes import TABLE_1, add_light, depsgraph


def check_rig_file_is_placed_and_removed(work):
    """The paper's Table 1: its lights light the pictures, the scene's own do not, and nothing is left of them."""
    _, obj = studio()
    before = everything()
    folder = work / "file"
    result = sb.render_batch(folder, 1, [DATA / "table1.json"])
    assert result.failed == () and names(result.rendered, folder) == ["table1/0001.exr"]
    lights = [(np.array(color) / 255, distance) for _name, color, distance in TABLE_1]
    np.testing.assert_allclose(shown_in(folder / "table1/0001.exr"), expected(*lights), rtol=2e-6)
    (entry,) = manifest_of(folder)
    reports = {row["name"]: row for row in entry["skins"][0]["lamps"]}
    assert {name for name, row in reports.items() if not row["reason"]} == {"Light1", "Light2", "Light3"}
    assert_same(before)
    # The rig goes along with the skin it is put onto.
    obj.location = (2.0, 3.0, 4.0)
    bpy.context.scene.camera.location = (2.0, 3.0, 9.0)
    sb.render_batch(work / "onto", 1, {"there": DATA / "table1.json"}, onto=obj)
    np.testing.assert_allclose(shown_in(work / "onto/there/0001.exr"), expected(*lights), rtol=2e-6)
    # A rig of all kinds of light, which give in mode physical what the core computes for the file itself.
    obj.skinglow.mode = "PHYSICAL"
    before = everything()
    rig = sg.read_light_rig(DATA / "all_kinds.json")
    sb.render_batch(work / "kinds", 1, [str(DATA / "all_kinds.json")], onto=obj)
    (entry,) = manifest_of(work / "kinds")
    lights = [as_this_blender_has_it(light) for light in rig.lights if light.visible]
    each = {light.name: sg.object_irradiance([light], rig.point) for light in lights}
    assert all(np.all(weight > 0.0) for weight in each.values()), "all four kinds reach the point"
    for row in entry["skins"][0]["lamps"]:
        if row["name"] in each:
            np.testing.assert_allclose(row["weight"], each.pop(row["name"]), rtol=2e-5, err_msg=row["name"])
    assert not each
    assert_same(before)
    assert ("spot_cosine" in "".join(entry["notes"])) == (bpy.app.version >= (4, 0, 0))


def as_this_blender_has_it(light):
    """Whether a spot falls off by the cosine to its axis, and whether a ball can be one, depends on the version."""
    if light.kind not in ("POINT", "SPOT"):
        return light
    names = "kind color position direction power name radius spot_angle spot_blend".split()
    has_balls = "use_soft_falloff" in bpy.types.PointLight.bl_rna.properties
    return sg.Light(
        **{name: getattr(light, name) for name in names},
        spot_cosine=light.kind == "SPOT" and bpy.app.version < (4, 0, 0),
        soft_falloff=light.soft_falloff or not has_balls,
    )


def check_studio_light(work):
    """Blender's own format of lights, which are suns."""
    studio()
    sb.render_batch(work / "sl", 1, [DATA / "two_lamps.sl"])
    (entry,) = manifest_of(work / "sl")
    suns = [row for row in entry["skins"][0]["lamps"] if not row["reason"]]
    assert [row["kind"] for row in suns] == ["SUN"] * len(suns) and len(suns) == 2
    assert entry["notes"] == sg.read_light_rig(DATA / "two_lamps.sl").notes


def check_lights_by_name_and_hidden_ones(work):
    """Rigs by light names: a light hidden in renders is visible if named; instanced and animated ones are hidden."""
    studio()
    hidden = add_light("Hidden", color=(0.0, 1.0, 0.0), location=(0.0, 0.0, 2.0))
    hidden.hide_render = True
    blinking = add_light("Blinking", color=(1.0, 1.0, 1.0), location=(0.0, 0.0, 0.5))
    for frame in (1, 2):
        blinking.hide_render = frame == 2
        blinking.keyframe_insert("hide_render", frame=frame)
    inside = bpy.data.collections.new("Inside")
    add_light("Instanced", color=(0.0, 0.0, 1.0), location=(0.0, 0.0, 3.0), collection=inside)
    instancer = bpy.data.objects.new("Instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", inside
    bpy.context.scene.collection.objects.link(instancer)
    before = everything()
    rigs = {"hidden": ["Hidden"], "blinking": ["Blinking"], "inside": ["Instanced", "Hidden"]}
    result = sb.render_batch(work / "names", "1-2", rigs)
    assert result.failed == ()
    green, white, blue = ((0, 1, 0), 2.0), ((1, 1, 1), 0.5), ((0, 0, 1), 3.0)
    for name, lights in (
        ("hidden/0001", [green]),
        ("hidden/0002", [green]),
        ("blinking/0001", [white]),
        ("blinking/0002", []),
        ("inside/0001", [green, blue]),
    ):
        picture = shown_in(work / f"names/{name}.exr")
        np.testing.assert_allclose(picture, expected(*lights), rtol=1e-5, err_msg=name)
    assert_same(before)
    # As the scene has it: no rig is asked for.
    sb.render_batch(work / "as_it_is", 2)
    lights = [(color_at(rig, 2), 1.0) for rig in RIGS] + [blue]
    np.testing.assert_allclose(shown_in(work / "as_it_is/scene/0002.exr"), expected(*lights), rtol=1e-5)


def check_former_name_of_a_rigs_lights(_work):
    """`Rig.lights` and the keyword still work, with a DeprecationWarning; nothing warns without them."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        old = sb.Rig("day", lamps=("Key",))
        assert old.lamps == ("Key",)
        assert [w.category for w in caught] == [DeprecationWarning] * 2
        assert {Path(w.filename).name for w in caught} == {Path(__file__).name}
        new = sb.Rig("day", ("Key",), None)
        assert new == old == sb.Rig(name="day", lights=("Key",)) == sb.Rig("night", ("Key",))._replace(name="day")
        assert len(caught) == 2
    try:
        sb.Rig("day", lamp=("Key",))
    except TypeError as error:
        assert "lamp" in str(error), error
    else:
        raise AssertionError("an unknown keyword was accepted")


def check_collection_disabled_in_renders_is_a_rig(work):
    """A rig in a collection of its own that is switched off, as artists keep them."""
    scene, _ = studio()
    scene.collection.children["cold"].hide_render = True
    before = everything()
    sb.render_batch(work / "off", 1, ["cold"])
    np.testing.assert_allclose(shown_in(work / "off/cold/0001.exr"), expected((color_at("cold", 1), 1.0)), rtol=1e-5)
    assert_same(before)
    # By its own name the light stays in a collection that is off: the picture fails and says why.
    result = sb.render_batch(work / "still_off", 1, {"lamp": ["cold lamp"], "warm": ["warm"]})
    ((path, reason),) = result.failed
    assert path.parent.name == "lamp" and "'cold lamp'" in reason and "disabled in renders" in reason
    assert names(result.rendered, work / "still_off") == ["warm/0001.exr"]
    assert not path.exists() and [e["rig"] for e in manifest_of(work / "still_off")] == ["warm"]
    assert_same(before)


def check_another_scene_and_linked_lights(work):
    """A scene that is not the window's, whose lights come from a library: they are hidden and shown as its own are."""
    key, fill = add_light("Key", color=(1.0, 0.0, 0.0)), add_light("Fill", color=(0.0, 0.0, 1.0))
    library = work / "lamps.blend"
    bpy.data.libraries.write(str(library), {key, fill})
    bpy.ops.wm.read_factory_settings(use_empty=True)
    studio()
    first = bpy.context.scene
    with bpy.data.libraries.load(str(library), link=True) as (there, here):
        here.objects = there.objects
    other = bpy.data.scenes.new("Other")
    other.render.engine = "CYCLES"
    for obj in (*here.objects, bpy.data.objects["Camera"], bpy.data.objects["Patch"]):
        other.collection.objects.link(obj)
    other.camera = bpy.data.objects["Camera"]
    for name in ("resolution_x", "resolution_y", "filter_size"):
        setattr(other.render, name, getattr(first.render, name))
    other.cycles.samples, other.cycles.use_denoising, other.cycles.device = 1, False, "CPU"
    other.render.image_settings.file_format, other.render.image_settings.color_depth = "OPEN_EXR", "32"
    before = everything()
    result = sb.render_batch(work / "other", 1, ["Key", "Fill"], scene=other)
    assert len(result.rendered) == 2, result
    for name, color in (("Key", (1, 0, 0)), ("Fill", (0, 0, 1))):
        picture = shown_in(work / f"other/{name}/0001.exr")
        np.testing.assert_allclose(picture, expected((color, 1.0)), rtol=1e-5, err_msg=name)
    assert_same(before)


def check_lights_of_one_name(work):
    """One of the file and two that are linked: a rig takes the one that it names, or says that it may be either."""
    for color, file in (((1.0, 0.0, 0.0), "red.blend"), ((0.0, 1.0, 0.0), "green.blend")):
        bpy.data.libraries.write(str(work / file), {add_light("Key", color=color), add_light("Rim", color=color)})
        bpy.ops.wm.read_factory_settings(use_empty=True)
    scene, _obj = studio()
    add_light("Key", color=(0.0, 0.0, 1.0), location=(0.0, 0.0, 1.0))
    for file in ("red.blend", "green.blend"):
        with bpy.data.libraries.load(str(work / file), link=True) as (there, here):
            here.objects = there.objects
        for obj in here.objects:
            scene.collection.objects.link(obj)
    refused(sb.SkinError, "'Rim' may be 'Rim [", sb.render_batch, work / "both", 1, ["Rim"])
    result = sb.render_batch(
        work / "each", 1, {"own": ["Key"], "red": ["Key [red.blend]"], "green": ["Rim [green.blend]"]}
    )
    assert len(result.rendered) == 3, result
    for name, color in (("own", (0, 0, 1)), ("red", (1, 0, 0)), ("green", (0, 1, 0))):
        picture = shown_in(work / f"each/{name}/0001.exr")
        np.testing.assert_allclose(picture, expected((color, 1.0)), rtol=1e-5, err_msg=name)


def check_light_at_each_pixel_has_room_for_every_rig(work):
    """Weights on the surface need nodes by the number of lights, which cannot be made while rendering."""
    _, obj = studio()
    many = bpy.data.collections.new("many")
    bpy.context.scene.collection.children.link(many)
    for number in range(6):
        place = (np.cos(number), np.sin(number), 0.3)
        add_light(f"Many {number}", "AREA", location=place, collection=many)
    depsgraph()
    for each in many.objects:
        each.hide_viewport = True
    before = everything()
    obj.skinglow.mode, obj.skinglow.weights = "PHYSICAL", "SURFACE"
    result = sb.render_batch(work / "surface", 1, ["warm", "many", DATA / "all_kinds.json"])
    assert result.failed == (), result
    assert [e["skins"][0]["weights"] for e in manifest_of(work / "surface")] == ["SURFACE"] * 3
    obj.skinglow.mode, obj.skinglow.weights = "PAPER", "OBJECT"
    assert_same(before)


def check_view_layers_and_motion_blur(work):
    """The manifest tells of every view layer, and of the frame itself, not of a step of its blur."""
    scene, obj = studio()
    scene.view_layers.new("Second")
    scene.render.use_motion_blur = True
    obj.keyframe_insert("location", frame=1)
    sb.render_batch(work / "layers", 2, ["warm"])
    (entry,) = manifest_of(work / "layers")
    assert {skin["view_layer"] for skin in entry["skins"]} == {"ViewLayer", "Second"}
    for skin in entry["skins"]:
        np.testing.assert_allclose(skin["weight"], color_at("warm", 2) / 2.0, rtol=1e-6)


def check_scene_is_restored_after_a_fault(work):
    scene, _ = studio()
    before = everything()

    def break_down(step):
        raise ZeroDivisionError(step.state)

    try:
        sb.render_batch(work / "fault", rigs=[DATA / "table1.json"], progress=break_down)
        raise AssertionError("the exception was lost")
    except ZeroDivisionError:
        assert_same(before)
