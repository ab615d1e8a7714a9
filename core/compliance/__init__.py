"""The inverse stiffness L of the free surface: equations (4) to (8)."""
