"""Operators, one a file, in rooms with what they share."""
