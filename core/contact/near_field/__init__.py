"""How a place gives way, closer than the mesh can tell."""
