"""Softness tools."""
