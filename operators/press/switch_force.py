"""Force Off and Force On: the device's motors let go at once, or take hold again slowly."""

import bpy

from ..scene.translated import shown
from ..scene.viewport import redraw_views
from ..session import press_session
from ..session.press_events import Source


class PALPATE_OT_switch_force(bpy.types.Operator):
    bl_idname = "palpate.switch_force"
    bl_label = "Force Off"
    bl_description = (
        "Let the device go limp at once, or let its force rise again slowly. Space does it too"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        session = press_session.current()
        by_device = session is not None and session.state.source is Source.DEVICE
        if not by_device:
            cls.poll_message_set(shown("No device presses now"))
        return by_device

    def execute(self, context: bpy.types.Context) -> set[str]:
        session = press_session.current()
        if session is not None:
            session.switch_force()
        redraw_views()
        return {"FINISHED"}


classes = (PALPATE_OT_switch_force,)
