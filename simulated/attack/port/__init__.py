"""A hostile host at a port: what it says to a device, and what the device makes of it."""
