"""Bar and status line of a modal operator that works for a while."""

from __future__ import annotations

import bpy

from ..reporting.translated import shown
from .modal_stay import Ending, ModalStay
from .viewport import redraw_views


class ModalProgress(ModalStay):
    """Stay of an operator that shows how far it is."""

    def begin(self, operator: Ending, context: bpy.types.Context, seconds: float = 0.0) -> None:
        """Have the operator called at least every so many ``seconds``, and show a bar."""
        context.window_manager.progress_begin(0, 100)
        super().begin(operator, context, seconds)

    def show(self, context: bpy.types.Context, text: str, share: float) -> None:
        """Show what is done and the ``share`` (0 to 1) of it."""
        self.say(context, f"Palpate: {text}     [Esc] {shown('Cancel')}")
        context.window_manager.progress_update(100 * share)
        redraw_views()

    def end(self, context: bpy.types.Context) -> None:
        """Take all of it away. Safe to repeat."""
        context.window_manager.progress_end()
        super().end(context)
