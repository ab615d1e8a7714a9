"""Bake and its operators."""
