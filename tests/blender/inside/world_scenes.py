"""Worlds for the checks: nodes, images, and what they bring, computed apart from the add-on."""

import math

import bpy
import numpy as np
from skinglow_blender.read import world_image

#: Normals of the plane on which a world is measured: the axes' sides and between them.
NORMALS = ((0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (-0.48, 0.6, 0.64))


def world_tree(name="World"):
    """A new world of the scene's, without nodes; (tree, output)."""
    world = bpy.data.worlds.new(name)
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    bpy.context.scene.world = world
    tree = world.node_tree
    tree.nodes.clear()
    return tree, tree.nodes.new("ShaderNodeOutputWorld")


def background(tree, color=(1.0, 1.0, 1.0), strength=1.0):
    node = tree.nodes.new("ShaderNodeBackground")
    node.inputs["Color"].default_value = (*color, 1.0)
    node.inputs["Strength"].default_value = strength
    return node


def constant_world(color=(0.8, 0.4, 0.2), strength=1.0):
    tree, output = world_tree()
    node = background(tree, color, strength)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return node


def image_world(image, strength=1.0, projection="EQUIRECTANGULAR"):
    """(tree, Background, Environment Texture)."""
    tree, output = world_tree()
    light, texture = background(tree, strength=strength), tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image, texture.projection = image, projection
    tree.links.new(texture.outputs["Color"], light.inputs["Color"])
    tree.links.new(light.outputs[0], output.inputs["Surface"])
    # Cycles' own choice is a larger map, which takes seconds to fill.
    settings = bpy.context.scene.world.cycles
    settings.sampling_method, settings.sample_map_resolution = "MANUAL", 256
    return tree, light, texture


def mapped(tree, socket, kind, rotation, scale=(1.0, 1.0, 1.0), coordinate="Generated"):
    """Puts a Mapping before a vector socket, and Texture Coordinate before that unless coordinate is None."""
    node = tree.nodes.new("ShaderNodeMapping")
    node.vector_type = kind
    node.inputs["Rotation"].default_value = rotation
    node.inputs["Scale"].default_value = scale
    tree.links.new(node.outputs[0], socket)
    if coordinate is not None:
        source = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(source.outputs[coordinate], node.inputs["Vector"])
    return node


def directions(height):
    """(height, 2 height, 3) at the middles of an equirectangular image's pixels, the lowest row first."""
    theta = np.pi * (1.0 - (np.arange(height) + 0.5) / height)[:, None]
    azimuth = np.pi * (1.0 - 2.0 * (np.arange(2 * height) + 0.5) / (2 * height))[None, :]
    across = np.sin(theta)
    up = np.broadcast_to(np.cos(theta), (height, 2 * height))
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), up], axis=-1)


def smooth_radiance(d):
    """Each color of other harmonics up to l = 2, above 0; directions (..., 3)."""
    x, y, z = d[..., 0], d[..., 1], d[..., 2]
    red = 1.0 + 0.5 * x - 0.2 * y * z
    green = 0.8 + 0.3 * y + 0.25 * (3.0 * z * z - 1.0)
    blue = 0.9 - 0.4 * z + 0.3 * x * y + 0.2 * (x * x - y * y)
    return np.stack([red, green, blue], axis=-1)


def smooth_irradiance(n):
    """Its irradiance on normals (..., 3): bands times pi, 2 pi / 3 and pi / 4 (Ramamoorthi and Hanrahan 2001)."""
    x, y, z = n[..., 0], n[..., 1], n[..., 2]
    band1, band2 = 2.0 * math.pi / 3.0, math.pi / 4.0
    red = math.pi + band1 * 0.5 * x - band2 * 0.2 * y * z
    green = math.pi * 0.8 + band1 * 0.3 * y + band2 * 0.25 * (3.0 * z * z - 1.0)
    blue = math.pi * 0.9 - band1 * 0.4 * z + band2 * (0.3 * x * y + 0.2 * (x * x - y * y))
    return np.stack([red, green, blue], axis=-1)


def image_of(colors, name="Sky", is_float=True, colorspace=None):
    """A Blender image of (height, width, 3), the lowest row first, values as they are stored."""
    height, width = colors.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=is_float)
    if colorspace is not None:
        image.colorspace_settings.name = colorspace
    set_pixels(image, colors)
    return image


def set_pixels(image, colors):
    pixels = np.ones((*colors.shape[:2], 4), np.float32)
    pixels[:, :, :3] = colors
    image.pixels.foreach_set(pixels.ravel())
    image.update()


def coded(linear):
    """sRGB's code (IEC 61966-2-1) of linear light, rounded to 8 bits."""
    high = 1.055 * np.power(linear, 1.0 / 2.4) - 0.055
    return np.rint(np.where(linear <= 0.0031308, 12.92 * linear, high) * 255.0) / 255.0


def decoded(code):
    """Linear light of sRGB's code."""
    return np.where(code <= 0.04045, code / 12.92, np.power((code + 0.055) / 1.055, 2.4))


def mean_irradiance(colors):
    """pi times the mean radiance of an equirectangular image, in numpy."""
    height = len(colors)
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    weights = (edges[:-1] - edges[1:]) / 2.0
    return math.pi * (colors.mean(axis=1) * weights[:, None]).sum(axis=0)


class CountedReads:
    """Counts how often pixels are read."""

    def __enter__(self):
        self.count, self.original = 0, world_image.linear_pixels

        def counting(image, **options):
            self.count += 1
            return self.original(image, **options)

        world_image.linear_pixels = counting
        return self

    def __exit__(self, *_unused):
        world_image.linear_pixels = self.original


def store(colors, path):
    """Codes of an 8-bit picture to a PNG, as they are."""
    image = image_of(colors, "Stored", is_float=False)
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
