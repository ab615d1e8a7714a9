"""A body filled with cubes, as coarse as is liked."""
