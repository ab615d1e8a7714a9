"""Translation of texts in reports, tooltips, status bar and panels."""

from collections.abc import Callable

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence


def reported(text: str | PalpateError, /, **values: object) -> str:
    """Translated sentence, error or text with {names} to fill in, for a report.

    Blender's preferences let reports stay English in a translated interface.
    """
    return _translated(text, values, bpy.app.translations.pgettext_rpt)


def shown(text: str | PalpateError, /, **values: object) -> str:
    """Translated sentence, error or text with {names}, for any other place."""
    return _translated(text, values, bpy.app.translations.pgettext_iface)


def _translated(
    text: str | PalpateError, values: dict[str, object], translate: Callable[[str], str]
) -> str:
    sentence = text.sentence if isinstance(text, PalpateError) else text
    if not isinstance(sentence, Sentence):
        sentence = Sentence(sentence, **values)
    return sentence.translated(translate)
