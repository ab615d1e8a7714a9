"""A force that gives way at large depth."""
