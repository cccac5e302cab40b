# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows Blender's events: what changed is read, computed and shown again."""
