"""Properties of an object for large deformation: the drawn shape."""

from ...core.shape.shapes import EXPLANATIONS, SERIES_IS_PAPER
from .kinds import choice

# Files hold the numbers of these items: give no number twice.
SHAPE_ITEMS = [
    ("ROTATION_STRAIN", "Real", EXPLANATIONS["real"], "", 3),
    ("LINEAR", "Linear", EXPLANATIONS["linear"], "", 0),
    ("TABLE", "Paper", EXPLANATIONS["paper"], "", 1),
]
# Held by older files and scripts only; no panel offers it.
FORMER_ITEM = ("SERIES", "Series", str(SERIES_IS_PAPER), "", 2)


class ShapeProperties:
    """Part of ``object.palpate`` for large deformation.

    What Make Soft makes is Real; the default here is what objects of older files keep.
    """

    shape: choice(
        "Shape",
        "How the deformed shape is computed. Can be changed while you press",
        [*SHAPE_ITEMS, FORMER_ITEM],
        "LINEAR",
    )
