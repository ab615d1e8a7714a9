"""Soft body, its key and its file."""
