"""Simulated hand and the handle that it moves."""
