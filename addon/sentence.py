"""Sentences in a panel: translated, and on as many lines as the sidebar's width needs."""

import textwrap

import bpy

# Width of a letter in the sidebar, unscaled pixels.
LETTER_PIXELS = 7
# Letters that icon and margins take.
MARGIN_LETTERS, FEWEST_LETTERS = 5, 20


def say(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    text: str,
    icon: str,
    **figures: str,
) -> None:
    """Write a sentence; ``{names}`` in the text are filled in after it is translated."""
    scale = context.preferences.system.ui_scale
    across = int(context.region.width / scale / LETTER_PIXELS)
    column = layout.column(align=True)
    column.use_property_split = False
    said = bpy.app.translations.pgettext_iface(text)
    if figures:
        said = said.format(**figures)
    letters = max(FEWEST_LETTERS, across - MARGIN_LETTERS)
    for number, line in enumerate(textwrap.wrap(said, letters)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1", translate=False)
