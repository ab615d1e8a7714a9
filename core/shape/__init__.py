"""The drawn shape, and the force at large depth: equations (15) and (16)."""
