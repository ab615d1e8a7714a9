"""Near field: compliance of places below the resolution of the mesh."""
