"""Subsurface scattering of the user's own shader, which brings the same light through: told, and counted once."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender import blender_version, show_light_by
from skinglow_blender.show.subsurface import FADE_GROUP, FADE_PROPERTY, light_shown_by

from inside.bad_input import refused
from inside.material_sockets import connect, node_of, picture
from inside.scenes import add_light, camera_above, depsgraph, patch
from inside.undo_and_polls import do_undo_redo


def skin(thickness=(1.0,) * 4, amount=0.8):
    """A patch with a Principled BSDF that scatters below its surface, lit from above."""
    add_light(location=(0.0, 0.0, 3.0), energy=100.0)
    material = bpy.data.materials.new("Skin")
    principled_of(material, amount)
    obj = patch(material=material)
    sb.make_skin(obj, thickness=thickness, mode="physical")
    camera_above()
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def principled_of(material, amount):
    tree = blender_version.ensure_shader_tree(material)
    node = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    weight(node).default_value = amount
    return node


def weight(node):
    return blender_version.socket_named(node.inputs, "Subsurface Weight", "Subsurface")


def material_of(obj):
    return obj.material_slots[0].material


def hints(obj):
    return [fault.what for fault in sb.health(obj) if fault.is_hint]


def fades():
    return [
        node
        for tree in [m.node_tree for m in bpy.data.materials] + list(bpy.data.node_groups)
        for node in tree.nodes
        if FADE_PROPERTY in (getattr(node, "node_tree", None) or ())
    ]


def check_without_subsurface_there_is_nothing_to_tell(_work):
    obj = skin(amount=0.0)
    assert sb.health(obj) == [] and light_shown_by(material_of(obj)) == "SKINGLOW"


def check_where_it_is_found(_work):
    """In the Principled BSDF, a Subsurface Scattering node, behind mixes, reroutes and in groups; not if muted."""

    def scattering(tree):
        return tree.nodes.new("ShaderNodeSubsurfaceScattering")

    def principled(tree):
        node = tree.nodes.new("ShaderNodeBsdfPrincipled")
        weight(node).default_value = 0.1
        return node

    def connected(tree):
        node = tree.nodes.new("ShaderNodeBsdfPrincipled")
        weight(node).default_value = 0.0
        tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], weight(node))
        return node

    def mixed(tree):
        mix, reroute = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("NodeReroute")
        tree.links.new(scattering(tree).outputs[0], reroute.inputs[0])
        tree.links.new(reroute.outputs[0], mix.inputs[2])
        return mix

    def grouped(tree):
        inner = bpy.data.node_groups.new("Shader", "ShaderNodeTree")
        blender_version.new_group_socket(inner, "Shader", "Shader", "OUTPUT", "")
        inner.links.new(principled(inner).outputs[0], inner.nodes.new("NodeGroupOutput").inputs[0])
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = inner
        return node

    def muted(tree):
        node = principled(tree)
        node.mute = True
        return node

    for make, found in (
        (scattering, True),
        (principled, True),
        (connected, True),
        (mixed, True),
        (grouped, True),
        (muted, False),
    ):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj = skin(amount=0.0)
        tree = material_of(obj).node_tree
        tree.links.new(make(tree).outputs[0], node_of(obj).inputs["Surface"])
        depsgraph()
        assert bool(hints(obj)) == found, make.__name__
        assert light_shown_by(material_of(obj)) == ("BOTH" if found else "SKINGLOW"), make.__name__
        if found:
            show_light_by(material_of(obj), "SKINGLOW")
            assert not hints(obj) and len(fades()) == 1, make.__name__
            show_light_by(material_of(obj), "SUBSURFACE")
            assert not hints(obj) and not fades() and node_of(obj).mute


def check_the_button_gives_it_to_either(work):
    """Skinglow: subsurface is off where the skin is thin and full where it is thick. Subsurface: nothing is added."""
    obj = skin(thickness=(0.0, 12.0, 12.0, 0.0))
    node, shader = node_of(obj), material_of(obj).node_tree.nodes["Principled BSDF"]
    assert hints(obj) and "second time" in hints(obj)[0]
    node.inputs["Strength"].default_value = 0.0
    assert not hints(obj), "it does not shine"
    surface = picture(work, size=16)
    node.inputs["Strength"].default_value = 1.0
    both = picture(work, size=16)
    assert (both - surface).max() > 1e-3
    assert bpy.ops.skinglow.show_light_by(shown_by="SUBSURFACE") == {"FINISHED"}
    assert not hints(obj) and light_shown_by(material_of(obj)) == "SUBSURFACE"
    np.testing.assert_allclose(picture(work, size=16), surface, rtol=1e-6)
    assert bpy.ops.skinglow.show_light_by(shown_by="SKINGLOW") == {"FINISHED"}
    assert not hints(obj) and light_shown_by(material_of(obj)) == "SKINGLOW" and not node.mute
    assert round(fades()[0].inputs["Amount"].default_value, 6) == 0.8
    # The amount itself, as a color.
    tree = material_of(obj).node_tree
    tree.links.new(fades()[0].outputs["Amount"], tree.nodes["Material Output"].inputs["Surface"])
    amount = picture(work, size=16)[8, :, 0]
    thickness = (np.arange(16) + 0.5) / 16 * 12.0
    ramp = np.clip((thickness - 4.0) / 4.0, 0.0, 1.0)
    np.testing.assert_allclose(amount, 0.8 * ramp**2 * (3.0 - 2.0 * ramp), atol=2e-4)
    assert bpy.ops.skinglow.show_light_by(shown_by="SUBSURFACE") == {"FINISHED"}
    assert round(weight(shader).default_value, 6) == 0.8 and not weight(shader).is_linked
    assert not any(FADE_PROPERTY in tree for tree in bpy.data.node_groups)


def check_masked_skin_keeps_its_subsurface(work):
    """Where the Mask takes the light away, and where no thickness is known, subsurface stays."""
    obj = skin()
    connect(node_of(obj), "Mask", 0.25)
    show_light_by(material_of(obj), "SKINGLOW")
    tree = material_of(obj).node_tree
    tree.links.new(fades()[0].outputs["Amount"], tree.nodes["Material Output"].inputs["Surface"])
    np.testing.assert_allclose(picture(work)[..., 0], 0.8 * 0.75, rtol=1e-5)
    connect(node_of(obj), "Thickness", 20.0)
    show_light_by(material_of(obj), "SKINGLOW")
    np.testing.assert_allclose(picture(work)[..., 0], 0.8, rtol=1e-5)
    for link in list(tree.links):
        if link.to_socket.name == "Thickness":
            tree.links.remove(link)
    obj.data.attributes.remove(obj.data.attributes["skinglow_thickness_known"])
    np.testing.assert_allclose(picture(work)[..., 0], 0.8, rtol=1e-5)


def check_connected_amount_stays_connected(_work):
    obj = skin()
    tree, shader = material_of(obj).node_tree, material_of(obj).node_tree.nodes["Principled BSDF"]
    value = tree.nodes.new("ShaderNodeValue")
    tree.links.new(value.outputs[0], weight(shader))
    show_light_by(material_of(obj), "SKINGLOW")
    assert fades()[0].inputs["Amount"].links[0].from_node == value
    sb.remove_skin(obj)
    assert weight(shader).links[0].from_node == value and not fades()
    assert shader.outputs[0].links[0].to_node.bl_idname == "ShaderNodeOutputMaterial"


def check_what_cannot_be_handed_over_is_refused(_work):
    """A group that others use too, an animated amount, Light in use: in words, and nothing is changed."""
    obj = skin()
    refused(ValueError, "'NOBODY' is not allowed", show_light_by, material_of(obj), "nobody")
    out = material_of(obj).node_tree.nodes.new("ShaderNodeOutputAOV")
    link = material_of(obj).node_tree.links.new(node_of(obj).outputs["Light"], out.inputs["Color"])
    refused(sb.SkinError, "Light of the Skinglow node", show_light_by, material_of(obj), "SUBSURFACE")
    assert not node_of(obj).mute
    material_of(obj).node_tree.links.remove(link)
    shader = material_of(obj).node_tree.nodes["Principled BSDF"]
    weight(shader).keyframe_insert("default_value", frame=1)
    refused(sb.SkinError, "is animated", show_light_by, material_of(obj), "SKINGLOW")
    refused(RuntimeError, "is animated", bpy.ops.skinglow.show_light_by, shown_by="SKINGLOW")
    weight(shader).keyframe_delete("default_value", frame=1)
    inner = bpy.data.node_groups.new("Shader", "ShaderNodeTree")
    blender_version.new_group_socket(inner, "Shader", "Shader", "OUTPUT", "")
    scattering = inner.nodes.new("ShaderNodeSubsurfaceScattering")
    inner.links.new(scattering.outputs[0], inner.nodes.new("NodeGroupOutput").inputs[0])
    tree = material_of(obj).node_tree
    for _ in range(2):
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = inner
    tree.links.new(node.outputs[0], node_of(obj).inputs["Surface"])
    refused(sb.SkinError, "make it a single user", show_light_by, material_of(obj), "SKINGLOW")
    assert not fades()


def check_batch_and_repair_do_not_mind(work):
    """It glows as its settings say: a hint is no reason to refuse."""
    obj = skin()
    picture(work)
    assert hints(obj)
    assert len(sb.render_batch(work / "batch", frames=[1]).rendered) == 1
    assert bpy.ops.skinglow.repair() == {"FINISHED"}


def check_undo_and_redo(_work):
    skin()
    depsgraph()

    def shown_by():
        return light_shown_by(bpy.data.materials["Skin"]), len(fades()), bpy.data.node_groups.find(FADE_GROUP) >= 0

    def at_first():
        assert shown_by() == ("BOTH", 0, False), shown_by()

    def by_skinglow():
        assert shown_by() == ("SKINGLOW", 1, True), shown_by()

    def by_subsurface():
        assert shown_by() == ("SUBSURFACE", 0, False), shown_by()

    do_undo_redo(bpy.ops.skinglow.show_light_by, at_first, by_skinglow, shown_by="SKINGLOW")
    do_undo_redo(bpy.ops.skinglow.show_light_by, at_first, by_subsurface, shown_by="SUBSURFACE")


def check_why_the_button_is_gray(_work):
    """Without a skin, and with one that has no subsurface, in words."""
    patch()
    refused(RuntimeError, "Select a skin", bpy.ops.skinglow.show_light_by, shown_by="SKINGLOW")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    skin(amount=0.0)
    refused(RuntimeError, "no subsurface", bpy.ops.skinglow.show_light_by, shown_by="SKINGLOW")
