"""Properties of a scene for looking into bodies: pins and tetrahedra."""

from .kinds import choice, number, span, switch

# Files hold the numbers of these items: add new ones at the end only.
AXIS_ITEMS = [
    ("X", "X", "Cut across the world's X axis"),
    ("Y", "Y", "Cut across the world's Y axis"),
    ("Z", "Z", "Cut across the world's Z axis"),
]


class InspectionProperties:
    """Part of ``scene.palpate`` for what is drawn over the active object."""

    show_pins: switch("Show Pins", "Colour what never moves")
    show_tetrahedra: switch("Show Tetrahedra", "Draw the baked body, cut open by a plane")
    cut_axis: choice("Cut Across", "Axis of the cut", AXIS_ITEMS, "X")
    cut: number(
        "Cut At",
        "How much of the body is left along that axis",
        50.0,
        span(0.0, 100.0, precision=0, step=100, subtype="PERCENTAGE"),
    )
