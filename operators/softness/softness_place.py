"""Place of a softness measurement: the 3D cursor, the selected vertices, or as given by a script
or a click.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer import place_marks
from ..object.drawn_body import DrawnBody
from ..place import touched_place
from ..scene.drawn_surface import rest_coordinates


def place_in_body(
    drawn: DrawnBody, context: bpy.types.Context, operator: bpy.types.Operator
) -> NDArray[np.float64]:
    """Place (3,), metres in the body at rest: of what is seen nearest to the operator's ``at``, if
    that was set, else to the 3D cursor; or the middle of the selected vertices, as chosen.

    Raises
    ------
    PalpateError
        No vertex is selected.
    """
    softness = context.object.palpate_softness
    if not operator.properties.is_property_set("at") and softness.place == "VERTICES":
        return _middle_of_selected(drawn, context.object)
    given = operator.properties.is_property_set("at")
    world = operator.at if given else context.scene.cursor.location
    thing = context.object
    with place_marks.marked(thing):
        return touched_place.nearest(thing, drawn.frame, np.array(world)).rest


def _middle_of_selected(drawn: DrawnBody, thing: bpy.types.Object) -> NDArray[np.float64]:
    selected = np.zeros(len(thing.data.vertices), dtype=np.bool_)
    thing.data.vertices.foreach_get("select", selected)
    if not selected.any():
        raise PalpateError(
            "{name} has no selected vertices; select some in Edit Mode and leave it, or measure "
            "at the 3D cursor",
            name=thing.name,
        )
    local = rest_coordinates(thing.data).reshape(-1, 3)[selected].mean(axis=0)
    return drawn.frame.body_from_local(local)


def at_property() -> bpy.props.FloatVectorProperty:
    """Property of the place for scripts, world units."""
    return bpy.props.FloatVectorProperty(
        name="Place",
        description="The surface point nearest to this is asked, world coordinates. "
        "Without one, the panel's Measured At says where",
        size=3,
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )


def pick_property() -> bpy.props.BoolProperty:
    """Property of whether the place is clicked."""
    return bpy.props.BoolProperty(
        name="Pick",
        description="Click the place in the view",
        default=False,
        options={"SKIP_SAVE", "HIDDEN"},
    )
