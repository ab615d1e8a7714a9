"""Properties of a scene's strokes."""

import bpy

from ...operators.stroke.stroke_properties import MOTION_ITEMS
from .kinds import choice, number, span, switch


class StrokeProperties:
    """Part of ``scene.palpate`` for strokes."""

    stroke: choice("Stroke", "What a stroke does", MOTION_ITEMS, "PUSH")
    stroke_outward: switch("Outward", "Pull, turn back or spread; with Shift the other way")
    stroke_strength: number(
        "Strength",
        "How far a drag moves the surface: 1 follows the pointer",
        1.0,
        span(0.05, 20.0, precision=2, step=5),
    )
    stroke_mirrored: bpy.props.BoolVectorProperty(
        name="Mirrored", description="Mirror strokes across the object's axes", subtype="XYZ"
    )
