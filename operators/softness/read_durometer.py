"""Read Durometer: a virtual durometer at one place."""

import bpy

from ...core.softness.durometer import read_durometer
from ..object.drawn_body import DrawnBody
from ..reporting.translated import reported
from .softness_operator import SoftnessOperator
from .softness_place import at_property, pick_property, place_in_body


class PALPATE_OT_read_durometer(SoftnessOperator, bpy.types.Operator):
    bl_idname = "palpate.read_durometer"
    bl_label = "Read Durometer"
    bl_description = (
        "Press the indenter of the chosen scale into the object, and read what the device would "
        "show there"
    )

    at: at_property()
    pick: pick_property()

    def measure(self, context: bpy.types.Context, drawn: DrawnBody) -> None:
        thing = context.object
        softness = thing.palpate_softness
        reading = read_durometer(
            drawn.body,
            place_in_body(drawn, context, self),
            softness.shore_scale,
            young_modulus=thing.palpate.young_modulus,
        )
        softness.read_scale = reading.shore.scale
        softness.read_value = reading.shore.value
        softness.read_block = reading.block.value
        softness.read_warnings = "\n".join(warning.as_line() for warning in reading.warnings)
        for warning in reading.warnings:
            self.report({"WARNING"}, reported(warning))
        if not reading.warnings:
            self.report({"INFO"}, reported("Shore {shore}", shore=reading.shore))


classes = (PALPATE_OT_read_durometer,)
