"""The interface in other languages."""

import bpy

from .german import WORDS as GERMAN
from .japanese import WORDS as JAPANESE

DOMAIN = __package__
LANGUAGES = {"de_DE": GERMAN, "de": GERMAN, "ja_JP": JAPANESE, "ja": JAPANESE}
# Blender looks up labels of operators in a context of their own, and those that its own dictionary
# has in another sense in ours.
CONTEXTS = ("*", "Operator", "Palpate")


def register() -> None:
    """Add the dictionary."""
    words = {
        language: {(context, text): said for context in CONTEXTS for text, said in known.items()}
        for language, known in LANGUAGES.items()
    }
    bpy.app.translations.register(DOMAIN, words)


def unregister() -> None:
    """Take it out."""
    bpy.app.translations.unregister(DOMAIN)
