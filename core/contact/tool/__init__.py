"""Tools with a shape."""
