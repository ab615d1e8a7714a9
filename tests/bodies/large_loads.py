"""Ten loads that deform a body far: presses, pulls, a pinch, bends and twists."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import Equilibrium, NoEquilibrium, equilibrium

# The end of the body is this share of its length; spread loads act there.
END = 0.15

# How far the linear body's farthest node would move, in lengths of the body.
PRESSED, BENT = 0.15, 0.5


def carried(
    body: FreeSolid, forces: NDArray[np.float64]
) -> tuple[NDArray[np.float64], Equilibrium]:
    """``forces`` (f, 3), or nine tenths of what the solid carries of them, and how it looks."""
    try:
        return forces, equilibrium(body, forces)
    except NoEquilibrium as told:
        start = 0.9 * told.displacements
        forces = 0.9 * told.held * forces
    return forces, equilibrium(body, forces, start)


def large_loads(body: FreeSolid, axis: int) -> dict[str, NDArray[np.float64]]:
    """Forces (f, 3) at unit modulus by the names of the loads; ``axis`` points to the body's end.

    Some are more than the solid carries; see :func:`carried`.
    """
    places = body.positions
    length = float(np.ptp(places[:, axis]))
    low, high = places.min(axis=0), places.max(axis=0)
    along, across, third = np.roll(np.eye(3), -axis, axis=0)
    surface = places[body.surface]
    tip = body.surface[surface[:, axis].argmax()]
    beside = 0.5 * (low + high) + 0.5 * (high - low) * across
    opposite = 0.5 * (low + high) - 0.5 * (high - low) * across
    side, other = (
        body.surface[np.linalg.norm(surface - place, axis=1).argmin()]
        for place in (beside, opposite)
    )
    end = places[:, axis] >= high[axis] - END * length
    arms = places - places[end].mean(axis=0)

    def at(node: int, way: NDArray[np.float64]) -> NDArray[np.float64]:
        forces = np.zeros(places.shape)
        forces[node] = way
        return forces

    def spread(ways: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(end[:, None], ways, 0.0)

    def scaled(forces: NDArray[np.float64], share: float) -> NDArray[np.float64]:
        grown: NDArray[np.float64] = forces * (share * length / np.abs(body.linear(forces)).max())
        return grown

    return {
        "press on the end": scaled(at(tip, -along), PRESSED),
        "pull on the end": scaled(at(tip, along), BENT),
        "drag the end": scaled(at(tip, third), BENT),
        "press on a side": scaled(at(side, -across), PRESSED),
        "pinch": scaled(at(side, -across) + at(other, across), PRESSED),
        "press, spread": scaled(spread(-along), PRESSED),
        "pull, spread": scaled(spread(along), BENT),
        "bend": scaled(spread(across), BENT),
        "bend by its weight": scaled(node_volumes(body)[:, None] * third, BENT),
        "twist": scaled(spread(np.cross(along, arms)), BENT),
    }


def node_volumes(body: FreeSolid) -> NDArray[np.float64]:
    """The volume that each free node (f,) stands for, cubic metres, pinned corners left out."""
    term = body.solid.terms[0]
    touched = abs(term.gradients).sign().tocsr()
    corners = np.maximum(np.diff(touched.indptr), 1)
    volumes: NDArray[np.float64] = touched.T @ (np.repeat(term.volumes, 3) / (3 * corners))
    return volumes
