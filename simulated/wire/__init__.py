"""Simulated wire between board and host."""
