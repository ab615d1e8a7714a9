"""The interface in other languages: one .po file each, made into one for Blender by the package.

A checkout that is not packaged speaks English.
"""

import json
from pathlib import Path

import bpy

DOMAIN = __package__
PACKAGED = Path(__file__).with_name("words.json")
# Blender looks up labels of operators in a context of their own, and those that its own dictionary
# has in another sense in ours.
CONTEXTS = ("*", "Operator", "Palpate")


def words() -> dict[str, dict[str, dict[str, str]]]:
    """Translations of each language, by context and English text; ``*`` is for all contexts."""
    packaged: dict[str, dict[str, dict[str, str]]] = (
        json.loads(PACKAGED.read_text(encoding="utf-8")) if PACKAGED.is_file() else {}
    )
    return packaged


def register() -> None:
    """Add the dictionary."""
    bpy.app.translations.register(
        DOMAIN, {language: _in_contexts(known) for language, known in words().items()}
    )


def unregister() -> None:
    """Take it out."""
    bpy.app.translations.unregister(DOMAIN)


def _in_contexts(known: dict[str, dict[str, str]]) -> dict[tuple[str, str], str]:
    """Texts by context and English; what has a context of its own goes before."""
    return {
        (context, text): said
        for context in CONTEXTS
        for text, said in {**known["*"], **known.get(context, {})}.items()
    }
