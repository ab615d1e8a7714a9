"""The interface in other languages."""

import bpy

DOMAIN = __package__

WORDS: dict[str, dict[tuple[str, str], str]] = {}


def register() -> None:
    """Add the dictionary."""
    bpy.app.translations.register(DOMAIN, WORDS)


def unregister() -> None:
    """Take it out."""
    bpy.app.translations.unregister(DOMAIN)
