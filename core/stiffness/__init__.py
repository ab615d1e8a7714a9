"""The stiffness matrix K and its pins: equations (1) to (3)."""
