"""Recordings of the servo as files, and as frames of an animation."""
