"""Coarse body in a moment, to press until the bake is done."""
