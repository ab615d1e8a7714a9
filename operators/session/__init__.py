"""A running press."""
