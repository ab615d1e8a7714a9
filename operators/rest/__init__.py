"""Bodies that nobody holds: what they rest on, how they come to lie, and their objects."""
