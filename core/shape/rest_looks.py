"""Looks at a body where it rests as a linear one: how firm its law has it there, and its shape."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..rest.rest import BodyTouch, Rest
from .rotation_strain.finger_load import FingerLoad, Footing, Setting, alike, joined
from .shapes import LinearShape, Shape, pressed_by

Array = NDArray[np.float64]

# By this share loads may differ from those under which a body was looked at.
ALIKE = 0.01
# Beyond this share of its size a linear body on its way looks otherwise than its law has it.
SEEN = 0.02


@dataclass(frozen=True, eq=False)
class Looked:
    """A body by its law under ``loads``: its displacements (n, 3), None of a linear one, how many
    times as firm it is, and what it holds over what a linear one would.
    """

    shape: Shape
    loads: list[FingerLoad]
    deformed: Array | None
    firmness: float
    held: float

    def of(self, rest: Rest, times: float) -> Rest:
        """The body where it rests ``times`` as firm as its material."""
        elastic = rest.elastic / times * self.held
        return replace(rest, deformed=self.deformed, elastic=elastic)


# What each of the last bodies was seen to be, with tools on it and without: one that is laid down
# again where it lay is not looked at.
_last: dict[tuple[SoftBody, bool], Looked] = {}
MOST_KEPT = 16


def firmness_begun(body: SoftBody, shape: Shape, now: float) -> float:
    """How firm one begins that is laid down: as when it lay without tools."""
    last = _last.get((body, False))
    return last.firmness if now == 1.0 and last is not None and last.shape is shape else now


def look_at(rest: Rest, shape: Shape, times: float) -> Looked:
    """A body where it rests ``times`` as firm as its material; as it was seen before, if it was.

    Raises
    ------
    PalpateError
        The shape cannot be computed.
    """
    loads, key = loads_of(rest, times), (rest.body, any(len(one.nodes) for one in rest.tools))
    for one in (_last.get(key), _last.get((rest.body, not key[1]))):
        if one is not None and one.shape is shape and alike(loads, one.loads, ALIKE):
            return one
    _last.pop(key, None)
    if len(_last) >= MOST_KEPT:
        del _last[next(iter(_last))]
    _last[key] = _looked(rest, shape, times, loads)
    return _last[key]


def _looked(rest: Rest, shape: Shape, times: float, loads: list[FingerLoad]) -> Looked:
    if isinstance(shape, LinearShape) or not loads:
        return Looked(shape, loads, None, times, times)
    pressed = pressed_by(shape, loads, rest.young_modulus / times)
    firmness, deformed = pressed.firmness, pressed.displacements
    if deformed is None:
        deformed = shown(rest, shape, times).deformed
    return Looked(shape, loads, deformed, float(firmness.deepest), float(firmness.mean))


def shown(rest: Rest, shape: Shape, times: float) -> Rest:
    """A body on its way: as its law has it where it is bent so far that it would be seen."""
    loads = loads_of(rest, times)
    if isinstance(shape, LinearShape) or not loads:
        return rest
    linear = rest.displacements()
    if np.abs(linear).max() < SEEN * float(np.ptp(rest.body.mesh.nodes, axis=0).max()):
        return rest
    modulus = rest.young_modulus / times
    return replace(rest, deformed=shape.displacements(*joined(loads), modulus, rest.let_go))


def loads_of(rest: Rest, times: float) -> list[FingerLoad]:
    """Loads of all that touches a body, as on a linear one of its material."""
    return [
        FingerLoad(
            touch.nodes,
            touch.nodal_forces / times,
            by=_setting(rest, touch),
            firmness=times,
            let_go=rest.let_go,
        )
        for touch in rest.touches
        if len(touch.nodes)
    ]


def _setting(rest: Rest, touch: BodyTouch) -> Setting | None:
    if touch.by is None:
        return None
    moved = rest.placement.to_tool(touch.places) - touch.at_rest
    footing = Footing(touch.at_rest, moved, touch.pushes)
    return Setting(*touch.by, rest.body, touch.friction, footing)
