"""Simulated boards and their firmware."""
