"""What a modal operator holds of Blender while it runs: its timer, and words in bars."""

from __future__ import annotations

from typing import Protocol

import bpy

from .viewport import redraw_views


class Ending(Protocol):
    """Modal operator that can be ended from outside."""

    def cancel(self, context: bpy.types.Context) -> None:
        """End, and leave nothing behind."""


class ModalStay:
    """Stay of one operator, from :meth:`begin` to :meth:`end`."""

    def __init__(self) -> None:
        self._timer: bpy.types.Timer | None = None
        self._workspaces: set[str] = set()
        self._is_headed = False
        self._operator: Ending | None = None

    def begin(self, operator: Ending, context: bpy.types.Context, seconds: float = 0.0) -> None:
        """Send events to an operator, and a timer's at least every so many ``seconds``."""
        manager = context.window_manager
        if seconds:
            self._timer = manager.event_timer_add(seconds, window=context.window)
        manager.modal_handler_add(operator)
        self._operator = operator
        _stays.append(self)

    def say(self, context: bpy.types.Context, text: str) -> None:
        """Show a text in the status bar."""
        context.workspace.status_text_set(text)
        # Each has its own, and the user may have turned to another meanwhile.
        self._workspaces.add(context.workspace.name)

    def head(self, context: bpy.types.Context, text: str) -> None:
        """Show a text in the header of the view."""
        if context.area is not None:
            context.area.header_text_set(text)
            context.area.tag_redraw()
            self._is_headed = True

    def end(self, context: bpy.types.Context) -> None:
        """Take all of it away. Safe to repeat."""
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        for name in self._workspaces:
            workspace = bpy.data.workspaces.get(name)
            # None while Blender replaces its windows for another file.
            if workspace is not None:
                workspace.status_text_set(None)
        self._workspaces.clear()
        if self._is_headed:
            self._is_headed = False
            for window in context.window_manager.windows:
                for area in window.screen.areas:
                    if area.type == "VIEW_3D":
                        area.header_text_set(None)
        self._operator = None
        if self in _stays:
            _stays.remove(self)
        redraw_views()

    def cancel(self, context: bpy.types.Context) -> None:
        """End the operator."""
        if self._operator is not None:
            self._operator.cancel(context)


_stays: list[ModalStay] = []


def end_all(context: bpy.types.Context) -> None:
    """End all modal operators of Palpate: Blender tells none that its class is unregistered."""
    for stay in [*_stays]:
        stay.cancel(context)
