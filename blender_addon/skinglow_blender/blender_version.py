# SPDX-License-Identifier: GPL-3.0-or-later
"""All differences between Blender 3.4 and 5.2, so that the rest of the add-on is independent of the version."""

from typing import Any

import bpy
import numpy as np

from .errors import SkinError

VERSION = bpy.app.version

#: Before 4.0 the power of area lights and wide suns was normalized differently (skinglow.LEGACY_AREA_POWER_FACTOR,
#: skinglow.legacy_sun_power_factor), and a spot's beam had an additional cosine falloff. Measured with Cycles.
LEGACY_LIGHT_POWER = VERSION < (4, 0, 0)
SPOT_HAS_COSINE = VERSION < (4, 0, 0)


def eevee_engine() -> str:
    """The identifier of this version's EEVEE."""
    return "BLENDER_EEVEE_NEXT" if (4, 2, 0) <= VERSION < (5, 0, 0) else "BLENDER_EEVEE"


def new_group_socket(
    group: bpy.types.NodeTree,
    name: str,
    kind: str,
    in_out: str,
    description: str,
    **values: Any,  # noqa: ANN401  of the socket's attributes
) -> None:
    """Adds a socket to a node group's interface.

    kind    'Shader', 'Color', 'Vector', 'Float', or 'Factor': a number shown as a slider
    in_out  'INPUT' or 'OUTPUT'
    values  attributes of the socket, such as default_value
    """
    if hasattr(group, "interface"):
        base = "Float" if kind == "Factor" else kind
        socket = group.interface.new_socket(name, in_out=in_out, socket_type=f"NodeSocket{base}")
        if kind == "Factor":
            socket.subtype = "FACTOR"
    else:
        kind = "FloatFactor" if kind == "Factor" else kind
        socket = (group.inputs if in_out == "INPUT" else group.outputs).new(f"NodeSocket{kind}", name)
    socket.description = description
    for attribute, value in values.items():
        setattr(socket, attribute, value)


def group_sockets(group: bpy.types.NodeTree, in_out: str) -> frozenset[str]:
    """The names of a node group's inputs or outputs; in_out is 'INPUT' or 'OUTPUT'."""
    if hasattr(group, "interface"):
        sockets = (item for item in group.interface.items_tree if item.item_type == "SOCKET")
        return frozenset(socket.name for socket in sockets if socket.in_out == in_out)
    return frozenset(socket.name for socket in (group.inputs if in_out == "INPUT" else group.outputs))


def shader_tree(owner: bpy.types.ID) -> bpy.types.NodeTree | None:
    """The node tree that a material, light or world uses, or None."""
    if VERSION < (5, 0, 0) and not owner.use_nodes:
        return None
    return owner.node_tree


#: By engine: the one in whose place it evaluates a scene (commands/freezing.py).
STANDS_FOR: dict[str, str] = {}


def output_target(scene: bpy.types.Scene) -> str:
    """Which of the output nodes of a material, light or world the scene's engine uses."""
    engine = STANDS_FOR.get(scene.render.engine, scene.render.engine)
    return "EEVEE" if engine.startswith("BLENDER_EEVEE") else "CYCLES" if engine == "CYCLES" else "ALL"


def data_color_space(image: bpy.types.Image) -> str:
    """The name of the color space of plain numbers in the file's color management, which need not be Blender's own.

    Raises SkinError if it has none.
    """
    settings = image.colorspace_settings
    before = settings.name
    names = [item.identifier for item in settings.bl_rna.properties["name"].enum_items]
    try:
        # Blender's own name first, then that of ACES.
        for name in sorted(names, key=lambda name: (name != "Non-Color", name != "Raw")):
            settings.name = name
            if settings.is_data:
                return name
    finally:
        settings.name = before
    raise SkinError(
        "The color management has no color space for data, in which the lookup is stored: mark one as data "
        "(isdata: true) in the OpenColorIO configuration"
    )


def world_override(layer: bpy.types.ViewLayer) -> bpy.types.World | None:
    """The world that overrides the scene's in a view layer (4.4)."""
    return getattr(layer, "world_override", None)


def ensure_shader_tree(material: bpy.types.Material) -> bpy.types.NodeTree:
    """A material's node tree, created if it has none."""
    if VERSION < (5, 0, 0) and not material.use_nodes:
        material.use_nodes = True
    return material.node_tree


#: The emission of a material is not sampled as a light.
NO_EMISSION_SAMPLING = "NONE" if VERSION >= (3, 5, 0) else 0


def emission_sampling(material: bpy.types.Material) -> str | int | None:
    """How Cycles samples a material's emission (an enum since 3.5, on or off before); None without Cycles."""
    cycles = getattr(material, "cycles", None)
    if cycles is None:
        return None
    return cycles.emission_sampling if hasattr(cycles, "emission_sampling") else int(cycles.sample_as_light)


def set_emission_sampling(material: bpy.types.Material, value: str | int) -> None:
    """Sets a value as returned by `emission_sampling`."""
    cycles = getattr(material, "cycles", None)
    if cycles is None:
        return
    if hasattr(cycles, "emission_sampling"):
        cycles.emission_sampling = value
    else:
        cycles.sample_as_light = bool(value)


def socket_named(sockets: bpy.types.bpy_prop_collection, *names: str) -> bpy.types.NodeSocket | None:
    """The first socket with one of these names: those of the Principled BSDF were renamed in 4.0."""
    for name in names:
        if name in sockets:
            return sockets[name]
    return None


#: All properties that lights have in this version: to ask a light for one that it lacks takes longer than to read it.
LIGHT_PROPERTIES = frozenset(
    name
    for kind in (bpy.types.AreaLight, bpy.types.PointLight, bpy.types.SpotLight, bpy.types.SunLight)
    for name in kind.bl_rna.properties.keys()  # noqa: SIM118  a collection iterates over its items
)
HAS_LIGHT_LINKING = "light_linking" in bpy.types.Object.bl_rna.properties


def light_exposure(light: bpy.types.Light) -> float:
    """A light's exposure in stops (4.5); 0 before."""
    return light.exposure if "exposure" in LIGHT_PROPERTIES else 0.0


def light_temperature_color(light: bpy.types.Light) -> tuple[float, float, float] | None:
    """Linear color of a light's temperature, if it uses one (4.5)."""
    if "use_temperature" not in LIGHT_PROPERTIES or not light.use_temperature:
        return None
    return tuple(light.temperature_color)


def light_is_normalized(light: bpy.types.Light) -> bool:
    """Whether a light's power is independent of its size (always before 4.5)."""
    return "normalize" not in LIGHT_PROPERTIES or light.normalize


def light_has_soft_falloff(light: bpy.types.PointLight) -> bool:
    """Whether a point light or spot is softened close up (always before 4.1)."""
    return "use_soft_falloff" not in LIGHT_PROPERTIES or light.use_soft_falloff


def light_casts_shadows(light: bpy.types.Light) -> bool:
    """Whether a light casts shadows: EEVEE's setting, since 4.2 that of both engines, and Cycles' own before."""
    return light.use_shadow and (VERSION >= (4, 2, 0) or getattr(getattr(light, "cycles", None), "cast_shadow", True))


def animation_curves(owner: bpy.types.ID, path: str | None = None) -> list[bpy.types.FCurve]:
    """The F-curves and drivers of a data block, or of one of its properties; actions have layers since 4.4."""
    animation = owner.animation_data
    if animation is None:
        return []
    curves = list(animation.drivers)
    action = animation.action
    if action is not None and VERSION >= (4, 4, 0):
        bags = (strip.channelbag(animation.action_slot) for layer in action.layers for strip in layer.strips)
        curves += [curve for bag in bags if bag is not None for curve in bag.fcurves]
    elif action is not None:
        curves += action.fcurves
    return [curve for curve in curves if path is None or curve.data_path == path]


def literal_path(path: str) -> str:
    """An output path that Blender takes literally: since 4.5 braces in it are template variables."""
    return path if VERSION < (4, 5, 0) else path.replace("{", "{{").replace("}", "}}")


def light_receivers(obj: bpy.types.Object) -> bpy.types.Collection | None:
    """The receiver collection of a light's light linking (4.0); None: it lights all objects."""
    linking = obj.light_linking if HAS_LIGHT_LINKING else None
    return linking.receiver_collection if linking is not None else None


def has_shadow_linking(obj: bpy.types.Object) -> bool:
    """Whether only some objects cast shadows of a light (4.0)."""
    return HAS_LIGHT_LINKING and obj.light_linking.blocker_collection is not None


def corner_normals(mesh: bpy.types.Mesh) -> np.ndarray:
    """The shading normal of each face corner, (n_loops, 3) float32, in object space."""
    normals = np.empty(3 * len(mesh.loops), np.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", normals)
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals)
    return normals.reshape(-1, 3)


def node_inputs(modifier: bpy.types.NodesModifier) -> list[Any]:
    """What a modifier gives to the inputs of its geometry nodes; custom properties until 5.2."""
    if not hasattr(modifier, "properties"):
        return list(modifier.values())
    inputs = modifier.properties.inputs if modifier.node_group is not None else None
    names = [p.identifier for p in inputs.bl_rna.properties if p.type == "POINTER"] if inputs is not None else ()
    return [getattr(getattr(inputs, name), "value", None) for name in names if name != "rna_type"]
