"""Settle: let an object that nobody holds come to rest."""

from __future__ import annotations

import bpy
import numpy as np

from ..lying.coming_down import settle
from ..object import soft_object
from ..reporting.acting import Acting
from ..reporting.translated import reported
from ..reporting.wait_cursor import wait_cursor
from ..session import press_session


class PALPATE_OT_settle(Acting, bpy.types.Operator):
    bl_idname = "palpate.settle"
    bl_label = "Settle"
    bl_description = (
        "Let the soft object come to rest on its floor and colliders: it moves, turns and sags as "
        "it would lie there. The mesh stays as it is; Reset brings all back"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        if press_session.current() is not None:
            return "A press is going on; Enter keeps the shape, Escape restores it"
        return soft_object.refusal_unbaked(context.object)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        with wait_cursor(context):
            return self.execute(context)

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        lying = settle(thing, context.evaluated_depsgraph_get())
        strongest = max(float(np.linalg.norm(one.force)) for one in lying.rest.supports)
        self.report(
            {"INFO"},
            reported(
                "{name} rests: {force:.3g} N on what bears it most",
                name=thing.name,
                force=strongest,
            ),
        )


classes = (PALPATE_OT_settle,)
