"""Heads to look at: a person of CC0 shapes, and any head of a file: which way it looks, how large it is, its ears."""
