"""The stiffness matrix K, and what is held: equations (1) to (3)."""
