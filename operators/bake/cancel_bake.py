"""Cancel Bake: the button for those who do not press Escape."""

import bpy

from ..scene.translated import shown
from . import bake_session


class PALPATE_OT_cancel_bake(bpy.types.Operator):
    bl_idname = "palpate.cancel_bake"
    bl_label = "Cancel"
    bl_description = "Stop the bake; nothing is changed and nothing is left"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if bake_session.current() is None:
            cls.poll_message_set(shown("No bake is running"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        session = bake_session.current()
        if session is None:
            return {"CANCELLED"}
        session.end()
        return {"FINISHED"}


classes = (PALPATE_OT_cancel_bake,)
