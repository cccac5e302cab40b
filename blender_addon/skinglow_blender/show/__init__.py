# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts tables on the screen: lookup images, node groups and materials."""
