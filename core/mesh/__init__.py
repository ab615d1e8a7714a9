"""From a surface to tetrahedra."""
