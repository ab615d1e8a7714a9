"""Properties of an object for large deformation: drawn shape and force law."""

import bpy

from ...core.shape.force_at_depth.felt_force import EXPLANATIONS as FELT_EXPLANATIONS
from ...core.shape.shapes import EXPLANATIONS

# Files hold the numbers of these items: add new ones at the end only.
SHAPE_ITEMS = [
    ("LINEAR", "Linear", EXPLANATIONS["linear"]),
    ("TABLE", "Table (Paper)", EXPLANATIONS["table"]),
    ("SERIES", "Series", EXPLANATIONS["series"]),
    ("ROTATION_STRAIN", "Rotation-Strain", EXPLANATIONS["rotation-strain"]),
]
FELT_ITEMS = [
    ("LINEAR", "Linear", FELT_EXPLANATIONS["linear"]),
    ("CORRECTED", "Corrected", FELT_EXPLANATIONS["corrected"]),
]


class ShapeProperties:
    """Part of ``object.palpate`` for large deformation."""

    shape: bpy.props.EnumProperty(
        name="Shape",
        description="How the deformed shape is computed. Can be changed while you press",
        items=SHAPE_ITEMS,
        default="LINEAR",
    )
    felt: bpy.props.EnumProperty(
        name="Felt Force",
        description="How the force follows from large depths",
        items=FELT_ITEMS,
        default="LINEAR",
    )
