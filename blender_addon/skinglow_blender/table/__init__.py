# SPDX-License-Identifier: GPL-3.0-or-later
"""What a skin shows, by calls to the core: lights, world and settings in, a lookup table out."""
