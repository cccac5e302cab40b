# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of a mesh at its vertices: measured in a thread, stored as an attribute."""
