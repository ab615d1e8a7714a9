"""Softness in makers' words: Shore scales, a virtual durometer, curves and maps."""
