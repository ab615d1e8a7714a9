"""Operators on kept layers: what becomes of them."""
