"""Properties of an object: what it rests on where nothing pins it, and where it was before."""

import bpy

from .kinds import choice, chosen_collection, number, result, span, switch

FLOOR_ITEMS = [
    (
        "UNDER",
        "Under It",
        "The ground, at height 0; the object's lowest point where that is beneath the ground",
    ),
    ("HEIGHT", "At Height", "A floor without an edge at a height"),
    ("NONE", "None", "Colliders alone bear it"),
]


def _matrix() -> object:
    return bpy.props.FloatVectorProperty(size=16, options={"HIDDEN"})


class RestProperties:
    """Part of ``object.palpate`` for an object without pins."""

    floor: choice("Floor", "Floor that the object rests on", FLOOR_ITEMS, "UNDER")
    floor_height: number(
        "Height",
        "Height of the floor, in the world",
        0.0,
        span(-1e6, 1e6, soft_min=-10.0, soft_max=10.0, precision=4, step=1, subtype="DISTANCE"),
    )
    colliders: chosen_collection(
        "Colliders",
        "Objects of this collection bear the object: flat ones, boxes, any closed mesh, which may "
        "be animated, and soft ones, which give way when it settles",
    )
    rest_friction: number(
        "Friction",
        "Between the object and what it rests on: sideways force over pressing force",
        0.5,
        span(0.0, 5.0, soft_max=1.5, precision=2, step=5),
    )

    steady: switch(
        "Steady",
        "While it is pressed, your other hand keeps it from sliding, turning and falling over; "
        "Grab, Twist and pulls stretch it then, instead of carrying it",
    )

    # Where it was before it first came to lie, where it was laid last, and the floor found, m.
    is_laid: bpy.props.BoolProperty(options={"HIDDEN"})
    laid_from: _matrix()
    laid_to: _matrix()
    has_floor: bpy.props.BoolProperty(options={"HIDDEN"})
    floor_found: result(0.0)
    # Whether its keyframes are those of a baked animation.
    is_keyed: bpy.props.BoolProperty(options={"HIDDEN"})
