"""Properties of objects and scenes."""
