"""Devices for everybody without hardware."""
