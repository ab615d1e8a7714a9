"""Where softness is asked for: the object's body, ready, and the place under the 3D cursor."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from . import bake_session, press_session, soft_object
from .drawn_body import DrawnBody


def refusal(context: bpy.types.Context) -> str:
    """Why the active object cannot be asked now; empty if it can."""
    reason = soft_object.refusal(context.object)
    if not reason and not context.object.palpate.body_key:
        reason = f"{context.object.name} is not soft yet; press Make Soft first"
    if not reason and (bake_session.current() or press_session.current()):
        reason = "Finish baking or pressing first"
    return reason


def place_in_body(
    drawn: DrawnBody, context: bpy.types.Context, operator: bpy.types.Operator
) -> NDArray[np.float64]:
    """The operator's ``at`` if it was set, else the 3D cursor; metres in the body, (3,)."""
    given = operator.properties.is_property_set("at")
    world = operator.at if given else context.scene.cursor.location
    place: NDArray[np.float64] = drawn.frame.body_from_world(np.array(world, dtype=np.float64))
    return place


def at_property() -> bpy.props.FloatVectorProperty:
    """The place for scripts, world units."""
    return bpy.props.FloatVectorProperty(
        name="Place",
        description="The surface point nearest to this is asked, world coordinates. "
        "Without one, the 3D cursor says where",
        size=3,
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
