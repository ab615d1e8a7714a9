"""Haptic devices: ports, the link's frames, and a simulated device."""
