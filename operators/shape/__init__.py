"""Drawn shape and force law of a press."""
