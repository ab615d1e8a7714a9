"""Record: start or stop a recording of the running press."""

import bpy

from ..reporting.acting import Acting
from ..scene.viewport import redraw_views
from ..session import press_session


class PALPATE_OT_record(Acting, bpy.types.Operator):
    bl_idname = "palpate.record"
    bl_label = "Record"
    bl_description = (
        "Record every tick of the force loop: time, probe, contact, forces and state. A new "
        "recording replaces the one before"
    )

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        if press_session.current() is not None:
            return ""
        return "Start to press first, or choose Record from Start"

    def act(self, context: bpy.types.Context) -> None:
        session = press_session.current()
        if session is None or session.loop is None:
            return
        recorder = session.loop.recorder
        if recorder.going_on:
            recorder.stop()
        else:
            session.start_recording()
        redraw_views()


classes = (PALPATE_OT_record,)
