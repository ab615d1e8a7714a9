"""Softness in the maker's words: Shore scales, a virtual durometer, curves and maps."""
