"""Runs inside Blender: the materials of the person: skin by region masks, what is inside, eyes and hair."""

from __future__ import annotations

from pathlib import Path

import bpy  # isort: skip  (importing it makes the others importable in the wheels)
import numpy as np

from studies.heads.human_head import Part

Color = tuple[float, float, float]

SKIN: Color = (0.62, 0.36, 0.25)
#: Masks of the package, the color they bring and how much of it.
REGIONS: dict[str, tuple[Color, float]] = {
    "lips": ((0.50, 0.16, 0.14), 0.75),
    "ears": ((0.62, 0.27, 0.19), 0.5),
    "eyelids": ((0.50, 0.27, 0.20), 0.6),
}
#: Parts of the eye by the distance from its axis over the radius.
PUPIL, IRIS, LIMBUS = 0.17, 0.47, 0.52


class Nodes:
    """Builds one material."""

    def __init__(self, name: str) -> None:
        self.material = bpy.data.materials.new(name)
        if self.material.node_tree is None:
            self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.surface = self.tree.nodes["Principled BSDF"]

    def set(self, *names: str, value: object) -> None:
        """The input of the surface by the first of its names in this version."""
        next(self.surface.inputs[name] for name in names if name in self.surface.inputs).default_value = value

    def add(self, kind: str, **inputs: object) -> bpy.types.Node:
        """A node with values or sockets for its inputs."""
        node = self.tree.nodes.new("ShaderNode" + kind)
        for name, value in inputs.items():
            self.put(value, node.inputs[name])
        return node

    def put(self, value: object, socket: bpy.types.NodeSocket) -> None:
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value

    def math(self, operation: str, a: object, b: object = 0.0) -> bpy.types.NodeSocket:
        node = self.add("Math")
        node.operation = operation
        self.put(a, node.inputs[0])
        self.put(b, node.inputs[1])
        return node.outputs[0]

    def mix(self, factor: object, a: object, b: object) -> bpy.types.NodeSocket:
        """Of colors: sockets or (r, g, b)."""
        node = self.add("Mix")
        node.data_type = "RGBA"
        sockets = {socket.identifier: socket for socket in node.inputs}
        self.put(factor, sockets["Factor_Float"])
        for name, color in (("A_Color", a), ("B_Color", b)):
            self.put((*color, 1.0) if isinstance(color, tuple) else color, sockets[name])
        return next(socket for socket in node.outputs if socket.identifier == "Result_Color")

    def ramp(self, value: bpy.types.NodeSocket, low: float, high: float) -> bpy.types.NodeSocket:
        """0 below low, 1 above high, smooth between."""
        node = self.add("MapRange", **{"Value": value, "From Min": low, "From Max": high})
        node.interpolation_type = "SMOOTHSTEP"
        return node.outputs[0]

    def attribute(self, name: str) -> bpy.types.Node:
        node = self.add("Attribute")
        node.attribute_name = name
        return node


def skin(masks: dict[str, Path]) -> bpy.types.Material:
    make = Nodes("skin")
    position = make.add("TexCoord").outputs["Object"]

    def noise(per_m: float, detail: float) -> bpy.types.NodeSocket:
        return make.add("TexNoise", Vector=position, Scale=per_m, Detail=detail).outputs[0]

    # Blood is unevenly spread, and melanin gathers in spots.
    blotches = make.ramp(noise(45.0, 3.0), 0.35, 0.75)
    color = make.mix(make.math("MULTIPLY", blotches, 0.35), SKIN, (0.62, 0.28, 0.19))
    spots = make.ramp(noise(420.0, 2.0), 0.62, 0.74)
    color = make.mix(make.math("MULTIPLY", spots, 0.22), color, (0.36, 0.18, 0.11))
    for name, (tint, amount) in REGIONS.items():
        image = make.add("TexImage")
        image.image = bpy.data.images.load(str(masks[name]))
        image.image.colorspace_settings.is_data = True
        color = make.mix(make.math("MULTIPLY", image.outputs["Color"], amount), color, tint)
    # The scalp between short hair is darker.
    color = make.mix(make.math("MULTIPLY", make.attribute("hair").outputs["Fac"], 0.8), color, (0.12, 0.075, 0.055))
    make.put(color, make.surface.inputs["Base Color"])

    pores = make.add("TexVoronoi", Vector=position, Scale=1300.0).outputs["Distance"]
    height = make.math("ADD", make.math("MULTIPLY", pores, 0.6), noise(900.0, 4.0))
    bump = make.add("Bump", Strength=0.35, Distance=0.00018, Height=height)
    make.put(bump.outputs["Normal"], make.surface.inputs["Normal"])
    rough = make.add("MapRange", **{"Value": noise(160.0, 2.0), "To Min": 0.38, "To Max": 0.58}).outputs[0]
    make.put(rough, make.surface.inputs["Roughness"])
    make.set("Specular IOR Level", "Specular", value=0.42)
    make.set("Subsurface Weight", "Subsurface", value=0.0)
    return make.material


def inside() -> bpy.types.Material:
    """The mouth and the sockets: dark and dull, no skin."""
    make = Nodes("inside")
    make.set("Base Color", value=(0.16, 0.045, 0.035, 1.0))
    make.set("Roughness", value=0.6)
    return make.material


def hair() -> bpy.types.Material:
    make = Nodes("hair")
    make.set("Base Color", value=(0.040, 0.020, 0.012, 1.0))
    make.set("Roughness", value=0.38)
    return make.material


def mark_iris(eye: bpy.types.Object, part: Part) -> None:
    """The direction from the ball's center over its radius, as an attribute."""
    low, high = part.vertices.min(axis=0), part.vertices.max(axis=0)
    toward = (part.vertices - 0.5 * (low + high)) / (0.5 * (high - low).max())
    attribute = eye.data.attributes.new("toward", "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", toward.astype(np.float32).ravel())


def eye() -> bpy.types.Material:
    """White, iris with radial streaks, pupil, and a wet coat."""
    make = Nodes("eye")
    parts = make.add("SeparateXYZ", Vector=make.attribute("toward").outputs["Vector"])
    x, y, z = parts.outputs
    flat = make.add("CombineXYZ", X=x, Y=z)
    radius = make.add("VectorMath", **{})
    radius.operation = "LENGTH"
    make.put(flat.outputs[0], radius.inputs[0])
    off = radius.outputs["Value"]
    around = make.add("VectorMath")
    around.operation = "NORMALIZE"
    make.put(flat.outputs[0], around.inputs[0])
    streaks = make.add("TexNoise", Vector=around.outputs["Vector"], Scale=14.0, Detail=4.0).outputs[0]
    iris = make.mix(make.ramp(streaks, 0.35, 0.68), (0.055, 0.028, 0.012), (0.20, 0.125, 0.055))
    iris = make.mix(make.ramp(off, 0.24, PUPIL), iris, (0.24, 0.14, 0.05))
    iris = make.mix(make.ramp(off, 0.36, IRIS), iris, (0.016, 0.012, 0.010))
    toward = make.attribute("toward").outputs["Vector"]
    veins = make.ramp(make.add("TexNoise", Vector=toward, Scale=7.0, Detail=6.0).outputs[0], 0.5, 0.7)
    white = make.mix(make.math("MULTIPLY", veins, 0.35), (0.66, 0.60, 0.56), (0.58, 0.34, 0.29))
    color = make.mix(make.ramp(off, IRIS, LIMBUS), iris, white)
    color = make.mix(make.ramp(off, PUPIL + 0.02, PUPIL), color, (0.002, 0.002, 0.002))
    color = make.mix(make.math("GREATER_THAN", y, 0.0), color, white)
    make.put(color, make.surface.inputs["Base Color"])
    make.set("Roughness", value=0.35)
    make.set("Coat Weight", "Clearcoat", value=1.0)
    make.set("Coat Roughness", "Clearcoat Roughness", value=0.02)
    return make.material


def plain(color_map: str | None, normal_map: str | None) -> bpy.types.Material:
    """Skin of a head without colors of its own, or with the given textures in its UV map."""
    make = Nodes("face")
    make.set("Base Color", value=(*SKIN, 1.0))
    make.set("Roughness", value=0.48)
    if color_map:
        picture = make.add("TexImage")
        picture.image = bpy.data.images.load(color_map)
        make.put(picture.outputs["Color"], make.surface.inputs["Base Color"])
    if normal_map:
        picture = make.add("TexImage")
        picture.image = bpy.data.images.load(normal_map)
        picture.image.colorspace_settings.is_data = True
        bump = make.add("NormalMap", Color=picture.outputs["Color"])
        make.put(bump.outputs["Normal"], make.surface.inputs["Normal"])
    return make.material
