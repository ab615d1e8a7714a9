"""Traction of what is pressed, as attributes of the mesh for shaders and geometry nodes."""
