"""Cancel Bake: a button besides Escape."""

import bpy

from ..reporting.acting import Acting
from . import bake_session


class PALPATE_OT_cancel_bake(Acting, bpy.types.Operator):
    bl_idname = "palpate.cancel_bake"
    bl_label = "Cancel"
    bl_description = "Stop the bake; nothing is changed and nothing is left"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return "" if bake_session.current() else "No bake is running"

    def act(self, context: bpy.types.Context) -> None:
        session = bake_session.current()
        if session is not None:
            session.end()


classes = (PALPATE_OT_cancel_bake,)
