"""Grips: patches of the surface that a stroke takes hold of and moves."""
