"""Record: begin to record the press that is going on, or stop it."""

import bpy

from ...core.errors import PalpateError
from ..scene.translated import reported, shown
from ..scene.viewport import redraw_views
from ..session import press_session


class PALPATE_OT_record(bpy.types.Operator):
    bl_idname = "palpate.record"
    bl_label = "Record"
    bl_description = (
        "Record every tick of the force loop: time, probe, contact, forces and state. A new "
        "recording replaces the one before"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        pressing = press_session.current() is not None
        if not pressing:
            cls.poll_message_set(shown("Start to press first, or choose Record from Start"))
        return pressing

    def execute(self, context: bpy.types.Context) -> set[str]:
        session = press_session.current()
        if session is None or session.loop is None:
            return {"CANCELLED"}
        recorder = session.loop.recorder
        try:
            if recorder.going_on:
                recorder.stop()
            else:
                session.start_recording()
        except PalpateError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        redraw_views()
        return {"FINISHED"}


classes = (PALPATE_OT_record,)
