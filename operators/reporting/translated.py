"""The user's language for what reports, tooltips, status bar and panel tell."""

from collections.abc import Callable

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence


def reported(text: str | PalpateError, /, **values: object) -> str:
    """A sentence or error, or a text with {names} to fill in, for a report.

    Blender's preferences let reports stay English in a translated interface.
    """
    return _told(text, values, bpy.app.translations.pgettext_rpt)


def shown(text: str | PalpateError, /, **values: object) -> str:
    """The same for anything else that is shown."""
    return _told(text, values, bpy.app.translations.pgettext_iface)


def _told(text: str | PalpateError, values: dict[str, object], tell: Callable[[str], str]) -> str:
    sentence = text.sentence if isinstance(text, PalpateError) else text
    if not isinstance(sentence, Sentence):
        sentence = Sentence(sentence, **values)
    return sentence.retold(tell)
