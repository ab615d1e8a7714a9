"""The interface in other languages."""

import bpy

DOMAIN = __package__

WORDS: dict[str, dict[tuple[str, str], str]] = {}


def register():
    bpy.app.translations.register(DOMAIN, WORDS)


def unregister():
    bpy.app.translations.unregister(DOMAIN)
