# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's scene: lights, world, skins and meshes, as the renderer evaluates them. Writes nothing."""
