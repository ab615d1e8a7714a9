"""Softness operators."""
