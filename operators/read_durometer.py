"""Read Durometer: a virtual durometer at the 3D cursor."""

import bpy

from ..core.errors import PalpateError
from ..core.softness.durometer import read_durometer
from .drawn_body import open_body
from .softness_place import at_property, place_in_body, refusal


class PALPATE_OT_read_durometer(bpy.types.Operator):
    bl_idname = "palpate.read_durometer"
    bl_label = "Read Durometer"
    bl_description = (
        "Press the indenter of the chosen scale into the object at the 3D cursor, and read what "
        "the device would show there"
    )
    bl_options = {"REGISTER", "UNDO"}

    at: at_property()

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = refusal(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        thing = context.object
        softness = thing.palpate_softness
        try:
            drawn = open_body(thing, context.scene)
            reading = read_durometer(
                drawn.body,
                place_in_body(drawn, context, self),
                softness.shore_scale,
                young_modulus=thing.palpate.young_modulus,
            )
        except PalpateError as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        softness.read_scale = reading.shore.scale
        softness.read_value = reading.shore.value
        softness.read_block = reading.block.value
        softness.read_warnings = "\n".join(reading.warnings)
        for warning in reading.warnings:
            self.report({"WARNING"}, warning)
        if not reading.warnings:
            self.report({"INFO"}, f"Shore {reading.shore}")
        return {"FINISHED"}


classes = (PALPATE_OT_read_durometer,)
