"""One way for operators to refuse: beforehand by their tooltip, while they work by a report."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import bpy

from ...core.errors import PalpateError
from .translated import reported, shown


class Acting:
    """Mixed into an operator: :meth:`refusal` says why it cannot run now, :meth:`act` does its
    work, and an error for the user becomes a report that nothing was done.
    """

    # What every bpy.types.Operator has.
    report: Callable[[set[str], str], None]
    poll_message_set: ClassVar[Callable[[str], None]]

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        """Why it cannot run now, a sentence; empty if it can."""
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
        """Do it.

        Raises
        ------
        PalpateError
            It cannot be done; nothing was.
        """
        raise NotImplementedError

    def guarded(self, act: Callable[[], None]) -> set[str]:
        """What Blender is told of work that may fail with a sentence for the user."""
        try:
            act()
        except PalpateError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        return {"FINISHED"}
