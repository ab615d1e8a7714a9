"""Touches as a body of its shape's law presses back: the linear ones, by its firmness."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..contact.touches import PointTouch, ToolTouch
from ..grip.cells import cells_of
from .rotation_strain.finger_load import FingerLoad, Setting
from .rotation_strain.pressed import Firmness
from .shapes import Shape, pressed_by

Array = NDArray[np.float64]

# Parts at most that a hand holds each for itself.
MOST_PARTS = 120
# Friction, as a share of the forces, that is none.
FREELY = 1e-6

One = TypeVar("One", PointTouch, ToolTouch, PointTouch | ToolTouch)


@dataclass(frozen=True, eq=False)
class Felt(Generic[One]):
    """What fingers feel.

    Attributes
    ----------
    touches : with the forces that are felt.
    firmness : by how much they are other than the linear ones, as a function of the depth.
    """

    touches: tuple[One, ...]
    firmness: Firmness


def loads_of(touches: Sequence[PointTouch | ToolTouch]) -> list[FingerLoad]:
    """Loads of all fingers that press, by the linear force law."""
    return [
        FingerLoad(
            one.nodes,
            one.nodal_forces,
            isinstance(one, PointTouch),
            _setting(one),
            let_go=_let_go(one),
        )
        for one in touches
        if len(one.nodes)
    ]


def _let_go(touch: PointTouch | ToolTouch) -> Array | None:
    """None at all of a body that is in a hand."""
    return np.zeros(3) if isinstance(touch, ToolTouch) and touch.body.in_hand else None


def _setting(touch: PointTouch | ToolTouch) -> Setting | None:
    """The tool where it is; None of a point, and of a tool that does not slide freely."""
    if isinstance(touch, PointTouch):
        return None
    along = touch.forces - touch.pushes[:, None] * touch.normals
    slides = np.abs(along).sum() <= FREELY * np.abs(touch.forces).sum()
    return Setting(touch.tool, touch.pose, touch.body) if slides else None


def held_loads(
    body: SoftBody, nodes: NDArray[np.int64], forces: Array, *, is_held: bool = False
) -> list[FingerLoad]:
    """Loads by which a hand holds nodes (k,) of the mesh where forces (k, 3) hold a linear body; of
    one without pins that ``is_held`` by another hand.
    """
    let_go = np.zeros(3) if is_held and body.is_free else None
    part = cells_of(body.mesh.nodes[nodes], MOST_PARTS)
    return [
        FingerLoad(nodes[part == one], forces[part == one], sticks=True, let_go=let_go)
        for one in range(int(part.max(initial=-1)) + 1)
    ]


def felt(shape: Shape, touches: Sequence[One], young_modulus: float) -> Felt[One]:
    """The linear ``touches`` of all fingers on a body, with the forces that its shape tells.

    Raises
    ------
    PalpateError
        They cannot be computed.
    """
    found = pressed_by(shape, loads_of(touches), young_modulus)
    share = found.firmness.deepest
    return Felt(tuple(one.times(share) for one in touches), found.firmness)
