"""Surfaces, and their tetrahedra."""
