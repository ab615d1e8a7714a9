"""What one finger presses with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...contact.tool.pose import Pose
from ...contact.tool.tools import Tool
from ..solid.free_solid import FreeSolid

Array = NDArray[np.float64]

# Share of the forces on nodes that presses at one place have in common, of that on the fewer.
SHARED = 0.5


@dataclass(frozen=True, eq=False)
class Footing:
    """Places (p,) that a tool presses: ``at_rest`` (p, 3), the way ``moved`` (p, 3) from there to
    where the contact has them, metres, in the body's frame, and their ``pushes`` (p,), N.
    """

    at_rest: Array
    moved: Array
    pushes: Array


@dataclass(frozen=True, eq=False)
class Setting:
    """A tool where it is, and the body as it touches it, with its imprint; Coulomb's ``friction``
    of it, none where the body slides, and its ``footing`` where that is known.
    """

    tool: Tool
    pose: Pose
    body: SoftBody
    friction: float = 0.0
    footing: Footing | None = None


@dataclass(frozen=True, eq=False)
class FingerLoad:
    """Load of one finger by the linear force law: forces (k, 3), N, on nodes (k,) of the mesh.

    ``sticks``: a point, which moves its place by all of its way; a tool's places may slide. ``by``:
    the tool, where it is known; of a pinned body one that slides. ``firmness``: how many times as
    firm the body was under it, which tells what it weighs beside its forces. ``let_go``: the only
    direction (3,) in which a hand that steadies the body lets it go; none of one that holds it.
    """

    nodes: NDArray[np.int64]
    forces: Array
    sticks: bool = False
    by: Setting | None = None
    firmness: float = 1.0
    let_go: Array | None = None

    @property
    def friction(self) -> float:
        """Of its tool; none where a hand keeps the body from sliding: no foot needs to hold it."""
        return 0.0 if self.by is None or self.let_go is not None else self.by.friction

    def times(self, share: float) -> FingerLoad:
        """With so much of its forces."""
        return replace(self, forces=share * self.forces)

    @property
    def weights(self) -> Array:
        """Share (k,) of the load that each node carries; of no load, alike."""
        sizes = np.linalg.norm(self.forces, axis=1)
        total = sizes.sum()
        alike = np.full(len(sizes), 1.0 / max(1, len(sizes)))
        shares: Array = sizes / total if total > 0.0 else alike
        return shares


def joined(loads: Sequence[FingerLoad]) -> tuple[NDArray[np.int64], Array]:
    """The nodes (k,) of all of them, and the forces (k, 3) on these."""
    nodes = np.concatenate([np.zeros(0, dtype=np.int64), *(load.nodes for load in loads)])
    return nodes, np.concatenate([np.zeros((0, 3)), *(load.forces for load in loads)])


def on_free_nodes(solid: FreeSolid, loads: Sequence[FingerLoad]) -> Array:
    """All of the loads as forces (f, 3) on the free nodes."""
    return solid.on_free_nodes(*joined(loads))


def totals(loads: Sequence[FingerLoad]) -> Array:
    """The force (k, 3) of each, N."""
    return np.array([load.forces.sum(axis=0) for load in loads]).reshape(-1, 3)


def alike(loads: Sequence[FingerLoad], others: Sequence[FingerLoad], share: float = 0.0) -> bool:
    """Whether the same fingers press on the same nodes, by forces that differ by no more than a
    share of all of them.
    """
    return len(loads) == len(others) and all(
        (one.sticks, one.let_go is None) == (other.sticks, other.let_go is None)
        and np.array_equal(one.nodes, other.nodes)
        and meet_alike(one.by, other.by)
        and abs(one.firmness - other.firmness) <= share * one.firmness
        and np.abs(one.forces - other.forces).sum() <= share * np.abs(one.forces).sum()
        for one, other in zip(loads, others, strict=True)
    )


def are_near(loads: Sequence[FingerLoad], others: Sequence[FingerLoad]) -> bool:
    """Whether the same fingers press at the same places, however much."""
    return len(loads) == len(others) and all(map(_is_near, loads, others))


def _is_near(one: FingerLoad, other: FingerLoad) -> bool:
    are_held = (one.let_go is None) == (other.let_go is None)
    if one.sticks != other.sticks or not (are_held and meet_alike(one.by, other.by)):
        return False
    pairs = [(one, other), (other, one)]
    return all(_lies_on(*pair) for pair in pairs if len(pair[0].nodes) <= len(pair[1].nodes))


def _lies_on(one: FingerLoad, other: FingerLoad) -> bool:
    """By the forces, so that a point by a node is near to itself in any triangle about that."""
    sizes = np.linalg.norm(one.forces, axis=1)
    on_it = np.isin(one.nodes, other.nodes)
    return bool(sizes[on_it].sum() >= SHARED * sizes.sum())


def meet_alike(one: Setting | None, other: Setting | None) -> bool:
    """Whether a tool meets a body as another does; the forces tell whether it does so there."""
    if one is None or other is None:
        return one is other
    return one.tool is other.tool and one.body is other.body


def let_go(loads: Sequence[FingerLoad]) -> Array | None:
    """The only direction (3,) in which a body under these may go; None where it may anyhow."""
    return next((load.let_go for load in loads if load.let_go is not None), None)
