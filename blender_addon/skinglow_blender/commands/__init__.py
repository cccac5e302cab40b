# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts and buttons ask for: make a skin, query it, check it, remove it, export it."""
