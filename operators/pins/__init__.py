"""Pins and stiff regions as vertex groups."""
