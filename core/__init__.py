"""From a surface to a force: tetrahedra, stiffness, compliance, contact. Knows no Blender."""
