"""Operators on objects that nobody holds: how they come to lie, and are brought back."""
