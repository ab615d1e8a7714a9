"""Refusal of operators: in advance by the tooltip, during work by a report."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import bpy

from ...core.errors import PalpateError
from .translated import reported, shown


class Acting:
    """Mixin for an operator: :meth:`refusal` is the reason why it cannot run now, :meth:`act` does
    its work, and a PalpateError becomes a report that nothing was done.
    """

    # Of every bpy.types.Operator.
    report: Callable[[set[str], str], None]
    poll_message_set: ClassVar[Callable[[str], None]]

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        """Reason why it cannot run now, a sentence; empty if it can."""
        return ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = cls.refusal(context)
        if reason:
            cls.poll_message_set(shown(reason))
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.guarded(lambda: self.act(context))

    def act(self, context: bpy.types.Context) -> None:
        """Do the work.

        Raises
        ------
        PalpateError
            It cannot be done; nothing was.
        """
        raise NotImplementedError

    def guarded(self, act: Callable[[], set[str] | None]) -> set[str]:
        """Run work that may raise PalpateError, and report it; returns Blender's result, finished
        where the work returns none.
        """
        try:
            return act() or {"FINISHED"}
        except PalpateError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
