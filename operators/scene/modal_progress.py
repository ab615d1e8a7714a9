"""Timer, bar and status line of a modal operator that works for a while."""

from __future__ import annotations

import bpy

from ..reporting.translated import shown
from .viewport import redraw_views


class ModalProgress:
    """Progress of one operator, from :meth:`begin` to :meth:`end`."""

    _timer: bpy.types.Timer | None = None

    def begin(
        self, operator: bpy.types.Operator, context: bpy.types.Context, seconds: float
    ) -> None:
        """Have the operator called at least every so many ``seconds``, and show a bar."""
        manager = context.window_manager
        self._timer = manager.event_timer_add(seconds, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(operator)

    def show(self, context: bpy.types.Context, text: str, share: float) -> None:
        """Show what is done and the ``share`` (0 to 1) of it."""
        context.workspace.status_text_set(f"Palpate: {text}     [Esc] {shown('Cancel')}")
        context.window_manager.progress_update(100 * share)
        redraw_views()

    def end(self, context: bpy.types.Context) -> None:
        """Take all of it away. Safe to repeat."""
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        context.window_manager.progress_end()
        # None while Blender replaces its windows for another file.
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw_views()
