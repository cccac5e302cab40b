"""What of the files that Blender reads a batch notices."""

import bpy
from skinglow_blender.batch.inputs import scene_inputs

from inside.batch_studio import studio

FILES = "wall.1001.png wall.1002.png film_0001.png film_0002.png cache.abc fog_01.vdb fog_02.vdb".split()


def check_changed_files_are_noticed(work):
    """A picture is rendered again when any file that Blender reads changed: tiles, frames of sequences, caches."""
    studio()
    data = work / "data"
    data.mkdir()
    for name in (
        "wall.1001.png",
        "wall.1002.png",
        "film_0001.png",
        "film_0002.png",
        "cache.abc",
        "fog_01.vdb",
        "fog_02.vdb",
    ):
        (data / name).write_bytes(b"first")
    (data / "film_x.png").write_bytes(b"no frame")
    tiled = bpy.data.images.new("tiled", 8, 8, tiled=True)
    tiled.filepath = str(data / "wall.<UDIM>.png")
    film = bpy.data.images.new("film", 8, 8)
    film.source, film.filepath = "SEQUENCE", str(data / "film_0001.png")
    fog = bpy.data.volumes.new("fog")
    fog.filepath, fog.is_sequence = str(data / "fog_01.vdb"), True
    assert bpy.ops.cachefile.open(filepath=str(data / "cache.abc")) == {"FINISHED"}
    for each in (tiled, film, fog, *bpy.data.cache_files):
        each.use_fake_user = True
    before = scene_inputs(bpy.context.scene)["files"]
    (data / "film_x.png").write_bytes(b"still no frame")
    assert scene_inputs(bpy.context.scene)["files"] == before
    for name in ("wall.1002.png", "film_0002.png", "cache.abc", "fog_02.vdb"):
        (data / name).write_bytes(b"second")
        after = scene_inputs(bpy.context.scene)["files"]
        assert after != before, name
        before = after
