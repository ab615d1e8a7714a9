"""Pins and tetrahedra of the active object, drawn into the 3D view."""
