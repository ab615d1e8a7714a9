"""The bake and its operators."""
