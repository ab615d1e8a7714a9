"""Dents as layers: displacements of the drawn vertices that a modifier adds."""
