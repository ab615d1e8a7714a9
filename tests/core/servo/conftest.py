"""Ports for the tests of the servo's session."""

from terminals import foreign_device, terminal  # noqa: F401
