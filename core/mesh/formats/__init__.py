"""Surfaces in OBJ, PLY and STL files, read by what is in them and never by what they promise."""
