"""Sentences in a panel: translated and wrapped to the sidebar's width."""

import textwrap
import unicodedata

import bpy

from ...core.sentence import Sentence
from ...operators.reporting.translated import shown

# Width of a letter in the sidebar, unscaled pixels.
LETTER_PIXELS = 7
# Letters' widths taken by icon and margins, and by the frame of a box.
MARGIN_LETTERS, BOX_LETTERS, FEWEST_LETTERS = 5, 4, 20
# Characters that must not begin a line in Japanese.
NEVER_FIRST = "、。」)・"


def say(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    text: str,
    icon: str,
    *,
    boxed: bool = False,
    **figures: str,
) -> None:
    """Write a sentence in the user's language; figures stand for the ``{names}`` in the text.

    It begins a line, so it begins with a capital, unless with a name. In a box there is less room.
    """
    scale = context.preferences.system.ui_scale
    across = int(context.region.width / scale / LETTER_PIXELS)
    column = layout.column(align=True)
    column.use_property_split = False
    said = shown(text, **figures)
    if not (text.template if isinstance(text, Sentence) else text).startswith("{"):
        said = said[:1].upper() + said[1:]
    letters = max(FEWEST_LETTERS, across - MARGIN_LETTERS - (BOX_LETTERS if boxed else 0))
    for number, line in enumerate(wrapped(said, letters)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1", translate=False)


def wrapped(text: str, letters: int) -> list[str]:
    """Text on lines of at most ``letters``. Wide letters count twice, and break anywhere."""
    if not any(_letters(letter) == 2 for letter in text):
        return textwrap.wrap(text, letters)
    lines = [""]
    for letter in text:
        full = sum(map(_letters, lines[-1])) + _letters(letter) > letters
        if full and letter not in NEVER_FIRST:
            lines.append("")
        lines[-1] += letter
    return [line.strip() for line in lines]


def _letters(letter: str) -> int:
    return 2 if unicodedata.east_asian_width(letter) in {"W", "F"} else 1
