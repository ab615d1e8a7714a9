"""Force Curve: force against depth at one place, as figures and as a table in a text block."""

import bpy

from ...core.contact.tool.tools import sphere
from ...core.softness.force_depth import MILLIMETRES, force_depth_curve
from ..object.drawn_body import DrawnBody
from ..reporting.translated import reported
from .softness_operator import SoftnessOperator
from .softness_place import at_property, pick_property, place_in_body


class PALPATE_OT_force_curve(SoftnessOperator, bpy.types.Operator):
    bl_idname = "palpate.force_curve"
    bl_label = "Force Curve"
    bl_description = (
        "Press straight in, deeper and deeper, and write force against depth into a text block"
    )

    at: at_property()
    pick: pick_property()
    depth: bpy.props.FloatProperty(
        name="Depth",
        description="How far to press; 0 for as far as is small there",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )

    def measure(self, context: bpy.types.Context, drawn: DrawnBody) -> None:
        thing = context.object
        softness = thing.palpate_softness
        metres = drawn.frame.metres_per_unit
        radius = metres * softness.finger_radius
        curve = force_depth_curve(
            drawn.body,
            place_in_body(drawn, context, self),
            metres * self.depth or None,
            tool=sphere(radius, "fingertip") if radius > 0.0 else None,
            young_modulus=thing.palpate.young_modulus,
        )
        softness.curve_depth = curve.depths[-1] * MILLIMETRES
        softness.curve_force = curve.forces[-1]
        softness.curve_stiffness = curve.secant / MILLIMETRES
        softness.curve_text = _write(f"{thing.name} force curve.csv", curve.as_csv())
        self.report(
            {"INFO"},
            reported(
                "{stiffness:.3g} N/mm; {text}",
                stiffness=softness.curve_stiffness,
                text=softness.curve_text,
            ),
        )


def _write(name: str, table: str) -> str:
    """Write a table into a text block, replacing the last one; returns its name."""
    text = bpy.data.texts.get(name) or bpy.data.texts.new(name)
    text.clear()
    text.write(table)
    return text.name


classes = (PALPATE_OT_force_curve,)
