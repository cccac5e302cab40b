"""What of the files that Blender reads a batch notices."""

from pathlib import Path

import bpy
from skinglow_blender.batch.files import input_files
from skinglow_blender.batch.inputs import scene_inputs

from inside.batch_studio import studio
from inside.scenes import add_light

FILES = (
    "wall.1001.png wall.1002.png film_0001.png film_0002.png cache.abc layer.abc fog_01.vdb fog_02.vdb lamp.ies "
    "spot.ies points.mdd fluid/config.uni fluid/data/d_1.vdb set.usda parts/chair.usda parts/wood.png"
).split()
#: Those that Blender itself does not name, or not alone.
NOTICED = (
    "wall.1002.png film_0002.png cache.abc layer.abc fog_02.vdb lamp.ies spot.ies points.mdd fluid/config.uni "
    "fluid/data/d_1.vdb set.usda parts/chair.usda parts/wood.png blendcache_scene/cloth_000001_00.bphys"
).split()
TEXT = {
    "set.usda": '#usda 1.0\ndef "Set" ( references = @./parts/chair.usda@</Chair> ) {}\n',
    "parts/chair.usda": "#usda 1.0\n( subLayers = [@../set.usda@] )\nasset inputs:file = @wood.png@\n",
}


def ies_node(tree, path):
    node = tree.nodes.new("ShaderNodeTexIES")
    node.mode, node.filepath = "EXTERNAL", str(path)


def scene_of_many_files(data):
    """A saved scene that reads files of every kind; they hold what no importer would take."""
    _, obj = studio()
    for name in FILES:
        (data / name).parent.mkdir(parents=True, exist_ok=True)
        (data / name).write_text(TEXT.get(name, "first"))
    tiled = bpy.data.images.new("tiled", 8, 8, tiled=True)
    tiled.filepath = str(data / "wall.<UDIM>.png")
    film = bpy.data.images.new("film", 8, 8)
    film.source, film.filepath = "SEQUENCE", str(data / "film_0001.png")
    fog = bpy.data.volumes.new("fog")
    fog.filepath, fog.is_sequence = str(data / "fog_01.vdb"), True
    for name in ("cache.abc", "set.usda"):
        assert bpy.ops.cachefile.open(filepath=str(data / name)) == {"FINISHED"}
    bpy.data.cache_files["cache.abc"].layers.new(filepath=str(data / "layer.abc"))
    light = add_light("Profile").data
    if light.node_tree is None:
        light.use_nodes = True
    ies_node(light.node_tree, data / "lamp.ies")
    ies_node(obj.active_material.node_tree, data / "spot.ies")
    obj.modifiers.new("points", "MESH_CACHE").filepath = str(data / "points.mdd")
    for each in (tiled, film, fog, *bpy.data.cache_files):
        each.use_fake_user = True
    # A domain that is a modifier would look for data to simulate.
    obj.modifiers.new("waves", "OCEAN").filepath = str(data / "fluid")
    bpy.ops.wm.save_as_mainfile(filepath=str(data / "scene.blend"))
    bakes = data / "blendcache_scene"
    bakes.mkdir()
    (bakes / "cloth_000001_00.bphys").write_bytes(b"first")


def check_changed_files_are_noticed(work):
    """A picture is rendered again when any file that Blender reads changed: tiles, frames of sequences, caches."""
    data = work / "data"
    scene_of_many_files(data)
    (data / "film_x.png").write_bytes(b"no frame")
    before = scene_inputs(bpy.context.scene)["files"]
    (data / "film_x.png").write_bytes(b"still no frame")
    assert scene_inputs(bpy.context.scene)["files"] == before
    for name in NOTICED:
        (data / name).write_text(TEXT.get(name, "") + "# second")
        after = scene_inputs(bpy.context.scene)["files"]
        assert after != before, name
        before = after


def check_list_of_files(work):
    data = work / "list"
    scene_of_many_files(data)
    names = [path.relative_to(data).as_posix() for path in input_files()]
    assert names == sorted([*FILES, "scene.blend", "blendcache_scene/cloth_000001_00.bphys"], key=Path), names
