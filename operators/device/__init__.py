"""Devices and what is said of them."""
