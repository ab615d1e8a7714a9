"""A free body laid down in the world, as the native module has it: mass, placement, supports."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import MOST_SUPPORTS
from palpate_servo import Prop as NativeProp
from palpate_servo import Tool as NativeTool

from ..body.soft_body import SoftBody
from ..contact.tool.native_tool import native_shape, native_surface
from ..contact.tool.pose import Pose
from ..contact.tool.tool_surface import Touchable
from ..errors import PalpateError
from .bearing_points import even_points
from .refusals import rest_errors
from .rest_settings import USUAL_REST, RestSettings
from .support import Floor, Support

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import Body, LaidTool, ToolSurface

# Displacements on a floor are found to some millionths of so many times how far a body sags, or of
# this share of its size.
REACH_PER_SAG = 30.0
LEAST_REACH = 1e-4

WORLD = Pose.at([0.0, 0.0, 0.0])


def native_prop(
    body: SoftBody,
    native: Body,
    supports: Sequence[Floor | Support],
    placement: Pose | None = None,
    settings: RestSettings = USUAL_REST,
    points: Touchable | None = None,
) -> NativeProp:
    """A body of which ``native`` is the whole native one, laid down on supports.

    ``placement`` is that of the body's frame in the world; None for one and the same. ``points``
    are what supports can press; None for as few as a tick of 1 kHz has time for.

    Raises
    ------
    PalpateError
        A body with pins or without a density, too many supports, invalid settings.
    """
    if not body.is_free:
        raise PalpateError("the body is pinned and cannot rest on anything; bake it without pins")
    if len(supports) > MOST_SUPPORTS:
        raise PalpateError(
            "{supports} supports bear the body; at most {most_supports} may",
            supports=len(supports),
            most_supports=MOST_SUPPORTS,
        )
    reach = _floor_reach(body, settings)
    borne = even_points(body, settings.spacing) if points is None else points
    surface = native_surface(native, *borne)
    position, rotation = at(WORLD if placement is None else placement)
    with rest_errors(ValueError):
        return NativeProp(
            native,
            mass=body.mass,
            centre=body.inertia.centre,
            inertia=body.moments,
            drag_time=settings.drag_time,
            is_steady=settings.steady,
            gravity=settings.gravity,
            supports=[_laid(surface, support, reach) for support in supports],
            position=position,
            rotation=rotation,
        )


def at(pose: Pose) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Position and rotation."""
    return pose.position, pose.rotation


def _floor_reach(body: SoftBody, settings: RestSettings) -> float:
    """Metres, some millionths of which do not count where the body lies: of how far it sags."""
    size = float(np.linalg.norm(np.ptp(body.mesh.nodes, axis=0)))
    weight = body.mass * float(np.linalg.norm(settings.gravity))
    sag = weight / (body.modulus(settings.young_modulus) * size)
    return min(size, max(REACH_PER_SAG * sag, LEAST_REACH * size))


def _laid(surface: ToolSurface, support: Floor | Support, reach: float) -> LaidTool:
    if isinstance(support, Floor):
        return surface, NativeTool.endless(reach), *at(support.pose), support.friction
    return surface, native_shape(support.tool), *at(support.pose), support.friction
