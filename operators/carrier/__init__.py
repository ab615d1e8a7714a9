"""Mesh as seen: what a body is baked from where modifiers make vertices, and what carries them."""
