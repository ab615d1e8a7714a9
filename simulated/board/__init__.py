"""Boards and their firmware."""
