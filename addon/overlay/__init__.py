"""Overlay drawn into the 3D view."""
