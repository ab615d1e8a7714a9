"""Haptic devices on a serial port: their link, the ports, and a simulated device."""
