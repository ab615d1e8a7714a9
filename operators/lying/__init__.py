"""Bodies that nobody holds: what they rest on, where they lie, and their objects there."""
