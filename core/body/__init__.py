"""The soft body, its key and its file."""
