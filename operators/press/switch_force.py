"""Force Off and Force On: motors off at once, or on with a ramp."""

import bpy

from ..reporting.acting import Acting
from ..scene.viewport import redraw_views
from ..session import press_session
from ..session.press_events import Source


class PALPATE_OT_switch_force(Acting, bpy.types.Operator):
    bl_idname = "palpate.switch_force"
    bl_label = "Force Off"
    bl_description = (
        "Let the device go limp at once, or let its force rise again slowly. Space does it too"
    )

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        session = press_session.current()
        by_device = session is not None and session.state.source is Source.DEVICE
        return "" if by_device else "No device presses now"

    def act(self, context: bpy.types.Context) -> None:
        session = press_session.current()
        if session is not None:
            session.switch_force()
        redraw_views()


classes = (PALPATE_OT_switch_force,)
