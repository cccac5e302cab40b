"""Nodes with tiles: which objects show them, where they are dark, and what becomes of their images."""

import bmesh
import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.live import handlers
from skinglow_blender.show.group_nodes import GroupNodes, build_nodes, make_whole, nodes_of
from skinglow_blender.show.image_pairs import FIRST_ROWS
from skinglow_blender.show.lut_image import LAYOUT_PROPERTY, images_of
from skinglow_blender.show.tile_image import TILE_PROPERTY, TILES, place_tiles, set_tile_property, show_tiles
from skinglow_blender.table.lut_layout import Layout
from skinglow_blender.thickness import tile_attribute
from skinglow_blender.thickness.tile_attribute import TEXEL_ATTRIBUTE, ensure_tiles, is_of_this_mesh, rows_of

from inside.bad_input import refused
from inside.scenes import add_light, black_material, camera_above, depsgraph, render_settings
from inside.tile_scenes import TILES_ONLY, block, fill, make_skins, render, without_updates

BOTH = GroupNodes(tiles=True)
SURFACE = GroupNodes(Layout(256, 1, 0, False), tiles=True)


def two_blocks():
    """Left and right halves of the picture, of one material; 1 unit is 1 mm."""
    add_light()
    left = block("Left", 2.0, (-1.0, 0.0, 0.0), black_material())
    right = block("Right", 2.0, (1.0, 0.0, 0.0), left.active_material)
    camera_above(4.0)
    render_settings(16, 8)
    return left, right


def constant(value):
    return lambda points: np.full((len(points), 3), value, np.float32)


def check_tiles_and_rows_in_one_material(work):
    """Each object shows what it is told to, by whatever else the group's nodes read."""
    left, right = two_blocks()
    group = make_skins([left, right], GroupNodes())
    with without_updates():
        by_rows = render(work / "rows.exr")
        for wanted in (BOTH, SURFACE):
            build_nodes(group, wanted)
            assert nodes_of(group) == wanted
            fill(group, [left], light=constant(0.25))
            shown = render(work / "both.exr")
            np.testing.assert_allclose(shown[:, :8], 0.25, rtol=1e-6)
            if wanted == BOTH:
                np.testing.assert_array_equal(shown[:, 8:], by_rows[:, 8:])
        build_nodes(group, TILES_ONLY)
        assert nodes_of(group) == TILES_ONLY and LAYOUT_PROPERTY not in group
        only = render(work / "only.exr")
        np.testing.assert_allclose(only[:, :8], 0.25, rtol=1e-6)
        assert only[:, 8:].max() == 0.0
        show_tiles(left, None)
        assert render(work / "none.exr").max() == 0.0
        tiles = TILES.all_of(group)
        assert len(tiles) == len(images_of(group)) == 4
        build_nodes(group, GroupNodes())
        np.testing.assert_array_equal(render(work / "again.exr"), by_rows)
        # They are kept, without what they held.
        assert TILES.all_of(group) == tiles and {image.size[1] for image in tiles} == {FIRST_ROWS}


def check_sockets(work):
    """Mask, Tint and Strength act on tiles as on rows, and so does the strength of the object."""
    left, _right = two_blocks()
    group = make_skins([left])
    node = next(n for n in left.active_material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
    with without_updates():
        fill(group, [left], light=constant(0.25))
        strength = left["skinglow_lut"][3]
        for name, value in (("Mask", 0.5), ("Tint", (1.0, 0.5, 0.25, 1.0)), ("Strength", 3.0)):
            node.inputs[name].default_value = value
        shown = render(work / "sockets.exr")[4, 4]
    np.testing.assert_allclose(shown, 0.25 * strength * 0.5 * 3.0 * np.array((1.0, 0.5, 0.25)), rtol=1e-6)


def check_dark_without_a_tile(work):
    """New faces have no texels, and faces between two tiles those of neither."""
    left, _right = two_blocks()
    group = make_skins([left])
    with without_updates():
        fill(group, [left], light=constant(0.25))
        assert is_of_this_mesh(left.data)
        edit = bmesh.new()
        edit.from_mesh(left.data)
        corners = [edit.verts.new(position) for position in ((1, -1, 0), (3, -1, 0), (3, 1, 0), (1, 1, 0))]
        edit.faces.new(corners)
        edit.to_mesh(left.data)
        edit.free()
        assert not is_of_this_mesh(left.data)
        shown = render(work / "new.exr")
        np.testing.assert_allclose(shown[:, :8], 0.25, rtol=1e-6)
        assert shown[:, 8:].max() == 0.0
        texels = tile_attribute.texels_of(left.data)
        texels[:, 2] = 1.0 + 7.37 * np.arange(len(texels))
        left.data.attributes[TEXEL_ATTRIBUTE].data.foreach_set("vector", texels.ravel())
        shown = render(work / "between.exr")
        assert (shown.max(axis=2) > 0.0).mean() < 0.3


def check_rows_of_tiles(_work):
    """Kept where nothing else needs them, apart for copies, and the images grow."""
    left, right = two_blocks()
    group = make_skins([left, right])
    with without_updates():
        for obj in (left, right):
            assert ensure_tiles(obj, bpy.context.scene) and not ensure_tiles(obj, bpy.context.scene)
        height = rows_of(left.data)
        keys = [sb.identity.key_of(obj) for obj in (left, right)]
        rows = place_tiles(group, {left: height, right: height})
        assert sorted(rows.values()) == [0, height]
        for obj, key in zip((left, right), keys, strict=True):
            set_tile_property(obj, (float(rows[key]), 1 / 1024, 1 / 16, 1.0))
        # As after loading: what the objects have counts, also of those that the view layer does not show.
        sb.session.SESSION.forget_tables()
        assert place_tiles(group, {right: height})[keys[1]] == rows[keys[1]]
        copy = left.copy()
        bpy.context.scene.collection.objects.link(copy)
        copy.skinglow.row = 2
        rows = place_tiles(group, {left: height, right: height, copy: height})
        assert len(set(rows.values())) == 3 and rows[keys[0]] == 0
        rows = place_tiles(group, {left: height, right: 40, copy: height})
        assert rows[keys[0]] == 0 and rows[keys[1]] >= height
        assert {tuple(image.size) for image in TILES.all_of(group)} == {(1024, 64)}
        # A skin that shows no tiles has no rows.
        show_tiles(left, None)
        sb.session.SESSION.forget_tables()
        copy.pop(TILE_PROPERTY)
        assert min(place_tiles(group, {copy: height}).values()) >= 0


def check_saved_and_removed(work):
    """Tiles are in a saved file; a removed skin leaves nothing."""
    left, right = two_blocks()
    group = make_skins([left, right])
    with without_updates():
        for mode in ("VIEWPORT", "RENDER"):
            fill(group, [left, right], mode, constant(0.25))
        before = render(work / "before.exr")
        handlers.on_save(None, None)
        bpy.ops.wm.save_as_mainfile(filepath=str(work / "tiles.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(work / "tiles.blend"))
        np.testing.assert_allclose(render(work / "after.exr"), before, rtol=1e-6)
    for name in ("Left", "Right"):
        obj = bpy.data.objects[name]
        sb.remove_skin(obj)
        assert TILE_PROPERTY not in obj and TEXEL_ATTRIBUTE not in obj.data.attributes
        assert tile_attribute.TILES_OF_MESH not in obj.data
    assert not [image.name for image in bpy.data.images if image.name != "Render Result"]
    assert not bpy.data.node_groups


def check_deleted_image(work):
    """It is told, and made anew by Repair."""
    left, _right = two_blocks()
    group = make_skins([left])
    with without_updates():
        fill(group, [left], light=constant(0.25))
        assert not sb.health(left)
        bpy.data.images.remove(TILES.all_of(group)[3])
        assert [fault.what for fault in sb.health(left)] == ["An image of its tiles was deleted"]
        make_whole(group)
        fill(group, [left], light=constant(0.25))
        assert not sb.health(left) and len(TILES.all_of(group)) == 4
        np.testing.assert_allclose(render(work / "anew.exr")[:, :8], 0.25, rtol=1e-6)


def check_copied_group(work):
    """A group made a single user shows the same images: its skin gets rows of its own in them."""
    left, right = two_blocks()
    group = make_skins([left, right])
    with without_updates():
        fill(group, [left, right], light=constant(0.25))
        right.data.materials[0] = right.active_material.copy()
        node = next(n for n in right.active_material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
        node.node_tree = group.copy()
        sb.show.group_following.follow_materials()
        assert right.skinglow.group == node.node_tree == group and len(TILES.all_of(group)) == 4
        fill(group, [left], light=constant(0.25))
        fill(group, [right], light=constant(0.5))
        shown = render(work / "apart.exr")
        np.testing.assert_allclose(shown[:, :8], 0.25, rtol=1e-6)
        np.testing.assert_allclose(shown[:, 8:], 0.5, rtol=1e-6)


def check_linked_mesh(work):
    """The mesh of a library keeps the tiles that it was saved with; it cannot get any."""
    left, right = two_blocks()
    make_skins([left, right])
    ensure_tiles(left, bpy.context.scene)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "library.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(work / "library.blend"), link=True) as (_there, wanted):
        wanted.meshes = ["Left", "Right"]
    for mesh in wanted.meshes:
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(f"Own {mesh.name}", mesh))
    depsgraph()
    assert not ensure_tiles(bpy.data.objects["Own Left"], bpy.context.scene)
    refused(sb.SkinError, "library.blend", ensure_tiles, bpy.data.objects["Own Right"], bpy.context.scene)
