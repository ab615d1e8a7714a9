"""Several tools on one body: each feels the others through it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .soft_body import SoftBody
from .tool_contact import Load, ToolTouch, press_tool
from .tools import Pose, Tool

# Turns in which each tool is pressed once with the others' last forces (block Gauss-Seidel).
MOST_TURNS = 200

# Forces that change by less than this share of the largest have been found.
CONVERGED = 1e-10


def press_tools(
    body: SoftBody,
    tools: Sequence[tuple[Tool, Pose]],
    *,
    young_modulus: float | None = None,
    start: Sequence[ToolTouch] | None = None,
) -> list[ToolTouch]:
    """Press several tools at once, without friction; one touch for each, in their order.

    Each tool meets the surface as the others' nodal forces have moved it, in turns, until the
    forces stay. What one does to another goes through the elements alone, in both directions by the
    same blocks; so the force on each is the slope of one energy in all poses.

    Parameters
    ----------
    young_modulus : pascal; the body's own unless given.
    start : the touches before, in the same order; each tool goes on from there.

    Raises
    ------
    PalpateError
        As :func:`.tool_contact.press_tool`.
    """
    touches = [
        press_tool(
            body, tool, pose, young_modulus=young_modulus, start=None if start is None else start[i]
        )
        for i, (tool, pose) in enumerate(tools)
    ]
    for _ in range(MOST_TURNS):
        change = 0.0
        for i, (tool, pose) in enumerate(tools):
            others = _together(touches[:i] + touches[i + 1 :])
            touch = press_tool(
                body,
                tool,
                pose,
                young_modulus=young_modulus,
                start=touches[i],
                outside=others,
            )
            change = max(change, float(np.linalg.norm(touch.force - touches[i].force)))
            touches[i] = touch
        if change <= CONVERGED * max(float(np.linalg.norm(touch.force)) for touch in touches):
            break
    return touches


def energy_of(touches: Sequence[ToolTouch]) -> float:
    """Elastic energy, joule, that all touches together hold in the body."""
    energy = sum(touch.energy for touch in touches)
    for i, touch in enumerate(touches):
        for other in touches[i + 1 :]:
            energy += _work_through_body(touch, other)
    return energy


def _work_through_body(touch: ToolTouch, other: ToolTouch) -> float:
    """Forces of one touch times what the other moves their nodes by, joule."""
    body, modulus = touch.body, touch.young_modulus
    here, there = (body.free_index(each.nodes) for each in (touch, other))
    held_here, held_there = here >= 0, there >= 0
    moved = body.compliance.apply(other.nodal_forces[held_there] / modulus, there[held_there])
    return float((touch.nodal_forces[held_here] * moved[here[held_here]]).sum())


def _together(touches: Sequence[ToolTouch]) -> Load:
    """All forces of the touches as one load."""
    return Load(
        np.concatenate([np.empty(0, dtype=np.int64)] + [touch.nodes for touch in touches]),
        np.concatenate([np.empty((0, 3))] + [touch.nodal_forces for touch in touches]),
    )
