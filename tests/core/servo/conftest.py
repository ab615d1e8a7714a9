"""Ports for the tests of the servo's session."""

from terminals import foreign_device, silent_port, terminal  # noqa: F401
