"""A rigid tool pressed on a soft body: which points it touches, with what force.

The readable reference of what the servo does a thousand times a second. The contact points are
those of :mod:`.contact_points`, fixed on the body; the law is that of :mod:`.tool_law`; here are
the ways to press, and the history.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...errors import PalpateError
from ..near_field.compliance_beneath import NearCorrection
from ..near_field.contact_points import ContactPoints
from .tool_candidates import compliance_between, looked_at, moved_by, points_entered
from .tool_friction import Rubbing, moved_anchors, settle_rubbing
from .tool_law import Candidates, Settled, distances_in_body, settle
from .tool_surface import surface_and_correction
from .tool_touch import Load, ToolTouch
from .tool_way import MOST_STRIDES, is_outside, is_within, overlap, stride, too_far, way_out
from .tools import Pose, Tool

# Share of the inner radius up to which a tool set on the body at rest needs no path from outside.
SHALLOW = 0.5

# Rounds of adding points that moved into the tool.
MOST_ADDITIONS = 20


def press_tool(
    body: SoftBody,
    tool: Tool,
    pose: Pose,
    *,
    young_modulus: float | None = None,
    friction: float = 0.0,
    start: ToolTouch | None = None,
    outside: Load | None = None,
    surface: ContactPoints | None = None,
    correction: NearCorrection | None = None,
) -> ToolTouch:
    """Press a tool on a body, from where ``start`` left it or, without one, from outside.

    With ``start`` the tool goes straight to the pose in as many strides as that takes; without, it
    comes the way the body would push it out. Depths beyond the tool's radius are answered, though
    no linear body can be right there.

    Parameters
    ----------
    young_modulus : pascal; the body's own unless given.
    friction : coefficient of Coulomb friction. With it the force depends on the way there.
    start : an earlier touch by the same tool on the same body.
    outside : forces of other fingers, which move the surface too.
    surface, correction : contact points to use in place of :func:`surface_for`'s, with what their
        compliance is besides the mesh's. With ``start``, those of that touch.

    Raises
    ------
    PalpateError
        Young's modulus is not a positive number, or friction a negative one; ``start`` is of
        another body or tool.
    """
    if start is None:
        state = set_down(
            body,
            tool,
            pose,
            young_modulus=young_modulus,
            friction=friction,
            surface=surface,
            correction=correction,
        )
        # With friction the way matters: it is always gone.
        shallow = friction == 0.0 and overlap(state, pose) <= SHALLOW * tool.inner_radius
        if shallow and not is_within(state, pose):
            return _settled(replace(state, free=True), pose, outside)
        start = replace(state, pose=way_out(state, pose), free=True)
    touch = replace(continued(start, body, tool, young_modulus), friction=friction)
    for _ in range(MOST_STRIDES):
        between, arrived = stride(tool, touch.pose, pose)
        touch = _settled(touch, between, outside)
        if arrived:
            return touch
    raise too_far(tool)


def set_down(
    body: SoftBody,
    tool: Tool,
    pose: Pose,
    *,
    young_modulus: float | None = None,
    friction: float = 0.0,
    surface: ContactPoints | None = None,
    correction: NearCorrection | None = None,
) -> ToolTouch:
    """A tool that appears at a pose. Inside the body it will feel nothing until it was outside."""
    modulus = body.modulus(young_modulus)
    if not (np.isfinite(friction) and friction >= 0.0):
        raise PalpateError(
            "friction coefficient is {friction}; give zero or more", friction=friction
        )
    placed: tuple[ContactPoints, NearCorrection | None]
    placed = surface_and_correction(body, tool) if surface is None else (surface, correction)
    none, vectors = np.empty(0), np.empty((0, 3))
    state = ToolTouch(
        body,
        tool,
        placed[0],
        placed[1],
        pose,
        modulus,
        np.empty(0, dtype=np.int64),
        vectors,
        none,
        vectors,
        vectors,
        np.empty((0, 0)),
        vectors,
        friction,
    )
    return replace(state, free=is_outside(state, pose))


def follow_tool(touch: ToolTouch, pose: Pose, *, outside: Load | None = None) -> ToolTouch:
    """One tick: the tool goes towards a pose by at most one stride, and feels the body there."""
    between, _ = stride(touch.tool, touch.pose, pose)
    return _settled(touch, between, outside)


def continued(
    start: ToolTouch, body: SoftBody, tool: Tool, young_modulus: float | None
) -> ToolTouch:
    """The touch to go on from, its forces at the modulus asked for."""
    if start.body is not body or start.tool is not tool:
        raise PalpateError(
            "tool {name}: the touch to start from is of another body or tool; leave it out",
            name=tool.name,
        )
    modulus = body.modulus(young_modulus)
    ratio = modulus / start.young_modulus
    return replace(
        start, young_modulus=modulus, forces=start.forces * ratio, pushes=start.pushes * ratio
    )


def _settled(state: ToolTouch, pose: Pose, outside: Load | None) -> ToolTouch:
    """The touch with the tool at ``pose``, reached in one step from ``state``."""
    state = replace(state, pose=pose, free=state.free or is_outside(state, pose))
    if not state.free:
        return state
    moved = moved_by(state, np.arange(len(state.surface)), outside)
    chosen = looked_at(state, pose, moved)
    if not chosen.size:
        return state
    forces = np.zeros((len(chosen), 3))
    forces[np.searchsorted(chosen, state.points)] = state.forces
    for _ in range(MOST_ADDITIONS):
        candidates = _candidates(state, chosen, moved[chosen])
        rubbing = _rubbing(state, pose, chosen)
        if state.friction > 0.0:
            settled = settle_rubbing(candidates, state.tool, pose, forces, rubbing)
        else:
            settled = settle(candidates, state.tool, pose, forces)
        entered = points_entered(state, pose, chosen, settled, moved)
        if not entered.size:
            break
        grown = np.union1d(chosen, entered)
        forces = np.zeros((len(grown), 3))
        forces[np.searchsorted(grown, chosen)] = settled.forces
        chosen = grown
    anchors = moved_anchors(settled, candidates, rubbing)
    touch = touch_of(state, chosen, settled, candidates.compliance, anchors)
    return replace(touch, free=not has_lost(state, touch, moved))


def touch_of(
    state: ToolTouch,
    chosen: NDArray[np.int64],
    settled: Settled,
    compliance: NDArray[np.float64],
    anchors: NDArray[np.float64],
) -> ToolTouch:
    """The touch of which the points ``chosen`` (p,) have ``settled``; their compliance (3p, 3p) and
    anchors (p, 3), in the body's coordinates.
    """
    pressed = np.flatnonzero(settled.pushes > 0.0)
    own = (3 * pressed[:, None] + np.arange(3)).reshape(-1)
    return replace(
        state,
        points=chosen[pressed],
        forces=settled.forces[pressed],
        pushes=settled.pushes[pressed],
        normals=settled.normals[pressed],
        displacements=settled.displacements[pressed],
        compliance=compliance[np.ix_(own, own)],
        anchors=state.pose.to_tool(anchors[pressed]),
        exact=settled.exact,
    )


def has_lost(before: ToolTouch, touch: ToolTouch, moved: NDArray[np.float64]) -> bool:
    """Whether a tool lost the surface, which others have ``moved`` (P, 3), while in the body.

    It would come out at any side, so it is let go.
    """
    if touch.touching or not before.touching:
        return False
    return not is_outside(touch, _back(touch, moved))


def _rubbing(state: ToolTouch, pose: Pose, chosen: NDArray[np.int64]) -> Rubbing:
    """Friction of the chosen points, their anchors moved along with the tool."""
    anchors = np.full((len(chosen), 3), np.nan)
    anchors[np.searchsorted(chosen, state.points)] = pose.to_body(state.anchors)
    return Rubbing(state.friction, anchors)


def _candidates(
    state: ToolTouch, chosen: NDArray[np.int64], offsets: NDArray[np.float64]
) -> Candidates:
    return Candidates(
        state.surface.positions[chosen],
        state.surface.normals[chosen],
        compliance_between(state, chosen, chosen),
        offsets,
    )


def _back(state: ToolTouch, moved: NDArray[np.float64]) -> Pose:
    """The pose before the other fingers moved the place (P, 3) that is nearest to the tool."""
    places = state.surface.positions + moved
    distances, _ = distances_in_body(state.tool, state.pose, places)
    return Pose(state.pose.position - moved[distances.argmin()], state.pose.rotation)
