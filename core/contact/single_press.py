"""Presses by a single call: points at the nearest place, tools set down and moved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.soft_body import SoftBody
from ..errors import PalpateError
from ..mesh.coordinates import LARGEST_COORDINATE
from .near_field.contact_points import ContactPoints
from .place import Place
from .press import USUAL, ContactSettings, PointGoal, Press, Spread
from .tool.pose import Pose, facing, resting_on
from .tool.tool_surface import surface_and_correction
from .tool.tools import Tool
from .touches import PointTouch, ToolTouch

Array = NDArray[np.float64]

# With friction the path matters: a straight one is divided into so many settled steps.
STEPS_WITH_FRICTION = 20


def touch_at(
    body: SoftBody,
    triangle: int,
    alpha: ArrayLike,
    by: ArrayLike,
    settings: ContactSettings = USUAL,
) -> PointTouch:
    """Touch surface triangle number ``triangle`` at area coordinates ``alpha``, moved ``by`` (3,).

    Raises
    ------
    PalpateError
        As of :class:`Press`.
    """
    goal = PointGoal(triangle, np.asarray(alpha, dtype=np.float64), np.asarray(by, np.float64))
    return _at_once(body, [goal], settings)[0]


def touch_nearest(
    body: SoftBody,
    at: ArrayLike,
    by: ArrayLike,
    settings: ContactSettings = USUAL,
) -> PointTouch:
    """Touch at the surface point nearest to ``at`` (3,), moved ``by`` (3,), metres.

    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> body, _ = bake(paper_cube()[0], BakeSettings(poisson_ratio=0.45, young_modulus=1e5))
    >>> touch = touch_nearest(body, at=(0.025, 0.025, 0.05), by=(0.0, 0.0, -0.002))
    >>> drawn = body.deform(touch.nodes, touch.nodal_forces)
    >>> bool(touch.force[2] > 0.0), drawn.shape
    (True, (73, 3))

    Raises
    ------
    PalpateError
        Coordinates that are not three finite numbers; as of :class:`Press`.
    """
    return press_points(body, [at], [by], settings)[0]


def press_points(
    body: SoftBody,
    at: ArrayLike | Sequence[ArrayLike],
    by: ArrayLike | Sequence[ArrayLike],
    settings: ContactSettings = USUAL,
) -> tuple[PointTouch, ...]:
    """Touch with several fingers at once, each at the surface point nearest to its ``at``.

    ``at`` and ``by`` are (m, 3), metres.

    Raises
    ------
    PalpateError
        Coordinates that are not rows of three finite numbers, as many of one as of the other; as of
        :class:`Press`.
    """
    starts, ways = pairs_checked(at, by)
    places = body.closest_points.query(starts)
    goals = [
        PointGoal(int(triangle), alpha, way)
        for triangle, alpha, way in zip(places.triangle, places.alpha, ways, strict=True)
    ]
    return _at_once(body, goals, settings)


def press_tool(
    body: SoftBody,
    tool: Tool,
    pose: Pose,
    settings: ContactSettings = USUAL,
    *,
    spread: Spread | None = None,
) -> ToolTouch:
    """Press one tool at a pose, approached from outside.

    ``spread``: contact points in place of the usual ones; see :class:`Press`.

    Raises
    ------
    PalpateError
        As of :class:`Press`.
    """
    (made,) = Press(body, [tool], settings, spread=spread).to([pose])
    return cast("ToolTouch", made)


def set_down(
    body: SoftBody,
    tool: Tool,
    place: Place,
    rotation: Array | None = None,
    points: ContactPoints | None = None,
) -> Pose:
    """Pose of a tool just out of contact, its -z side over a place.

    Without ``rotation`` (3, 3) that side is tangential to the surface, and the tool's x axis as
    close as possible to the body's. ``points`` are those that it meets, the usual ones unless told.
    """
    turn = facing(-place.axis, np.eye(3)[0]) if rotation is None else rotation
    points = surface_and_correction(body, tool)[0] if points is None else points
    return resting_on(tool, turn, place.position, -place.axis, points.positions)


def press_tools(
    body: SoftBody,
    tool: Tool,
    starts: Sequence[Pose],
    ways: ArrayLike,
    settings: ContactSettings = USUAL,
) -> tuple[ToolTouch, ...]:
    """Set tools of one kind down at ``starts`` and move them by ``ways`` (m, 3), metres, straight
    and all together.

    Raises
    ------
    PalpateError
        As of :class:`Press`.
    """
    press = Press(body, [tool] * len(starts), settings)
    steps, moved = STEPS_WITH_FRICTION if settings.friction else 1, np.asarray(ways)
    press.to(starts)
    for step in range(1, steps + 1):
        touches = press.to(
            [start.moved(step / steps * way) for start, way in zip(starts, moved, strict=True)]
        )
    return tuple(one for one in touches if isinstance(one, ToolTouch))


def _at_once(
    body: SoftBody,
    goals: Sequence[PointGoal],
    settings: ContactSettings,
) -> tuple[PointTouch, ...]:
    touches = Press(body, [None] * len(goals), settings).to(goals)
    return tuple(one for one in touches if isinstance(one, PointTouch))


def _point_checked(name: str, value: ArrayLike) -> Array:
    point = np.asarray(value, dtype=np.float64)
    if point.shape != (3,) or not (np.abs(point) <= LARGEST_COORDINATE).all():
        raise PalpateError(
            "--{name}: {point} is not a point; give three finite numbers in metres, none beyond "
            "{most:g}",
            name=name,
            point=np.asarray(value).tolist(),
            most=LARGEST_COORDINATE,
        )
    return point


def pairs_checked(
    at: ArrayLike | Sequence[ArrayLike], by: ArrayLike | Sequence[ArrayLike]
) -> tuple[Array, Array]:
    """Places and displacements of fingers, (m, 3), metres; errors as of :func:`press_points`."""
    starts, ways = (
        np.array([_point_checked(name, row) for row in np.asarray(value)]).reshape(-1, 3)
        for name, value in (("at", at), ("by", by))
    )
    if len(starts) != len(ways) or not len(starts):
        raise PalpateError(
            "--at is given {starts} times and --by {travels} times; give one --by for every --at, "
            "in the same order",
            starts=len(starts),
            travels=len(ways),
        )
    return starts, ways
