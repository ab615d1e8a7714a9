"""Contact: points and tools pressed on a body, equations (9) to (14)."""
