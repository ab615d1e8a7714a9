"""Geometrically nonlinear elasticity, and shapes of large deformation (section 5 of the paper)."""
