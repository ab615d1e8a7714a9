"""Haptic devices: ports, frames and status texts."""
