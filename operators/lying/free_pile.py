"""Bodies of several objects that press each other, among what these rest on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core.contact.tool.pose import Pose
from ...core.errors import PalpateError
from ...core.pile.pile import Pile
from ...core.pile.pile_settings import PileSettings
from ...core.rest.rest import Rest
from ...core.rest.support import Floor, Support
from ..object.drawn_body import DrawnBody, open_body
from .free_body import LANDING, Lying, above, scene_gravity, supports_under
from .placement import frame_at, placement_of
from .supports import Supports


@dataclass(frozen=True, eq=False)
class FreePile:
    """Bodies of objects that press each other; made by :func:`piled`.

    ``floor`` is the height of what they rest on, metres, None without one.
    """

    drawn: tuple[DrawnBody, ...]
    floor: float | None
    pile: Pile

    @property
    def size(self) -> float:
        """Diagonal of the smallest body, metres."""
        return min(drawn.size for drawn in self.drawn)

    def tick(self, seconds: float) -> None:
        """Go on by a tick.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        self.pile.tick(seconds)

    def settle(self) -> list[Lying]:
        """Where they come to rest, one after the other.

        Raises
        ------
        PalpateError
            They do not.
        """
        return self._lying(self.pile.settle())

    def now(self) -> list[Lying]:
        """Where they are now."""
        return self._lying(self.pile.rest)

    def _lying(self, rests: Sequence[Rest]) -> list[Lying]:
        return [
            _lying(drawn, rest, self.floor) for drawn, rest in zip(self.drawn, rests, strict=True)
        ]


def piled(
    things: Sequence[bpy.types.Object], graph: bpy.types.Depsgraph, height: float = LANDING
) -> FreePile:
    """Bodies of objects where these are, with the floor and colliders of all; where nothing is
    near beneath, down at a ``height`` over it, a share of the smallest one's size.

    Friction between them is the first one's; the floor the lowest of theirs.

    Raises
    ------
    PalpateError
        One cannot move by itself, nothing bears any, all are pinned, or they are too many.
    """
    opened = [(thing, open_body(thing, graph.scene)) for thing in things]
    free = [(thing, drawn) for thing, drawn in opened if drawn.body.is_free]
    found = [supports_under(thing, drawn, graph, besides=things) for thing, drawn in free]
    supports = _all_of(found)
    if not supports.all and len(free) == len(opened):
        raise PalpateError(
            "{name}: there is nothing under it; choose a floor or colliders under Rests On",
            name=things[0].name,
        )
    gravity = scene_gravity(graph.scene)
    size = min(drawn.size for _, drawn in opened)
    # A pinned one may be on the way.
    is_clear = len(free) == len(opened) and gravity[:2] == (0.0, 0.0) and gravity[2] < 0.0
    down = _way_down(free, supports, size, height * size) if is_clear else 0.0
    laid = []
    for thing, drawn in opened:
        placement = placement_of(drawn.frame)
        if drawn.body.is_free:
            placement = replace(placement, position=placement.position - [0.0, 0.0, down])
        body = replace(
            drawn.body, young_modulus=thing.palpate.young_modulus, density=thing.palpate.density
        )
        laid.append((body, placement))
    settings = PileSettings(friction=things[0].palpate.rest_friction, gravity=gravity)
    pile = Pile(laid, supports.all, settings=settings)
    return FreePile(tuple(drawn for _, drawn in opened), supports.floor, pile)


def _all_of(found: Sequence[Supports]) -> Supports:
    """Colliders of all, each once, and the lowest of their floors."""
    floors = [one for each in found for one in each.all if isinstance(one, Floor)]
    lowest = min(floors, key=lambda floor: floor.height, default=None)
    fixed: dict[str, Support] = {}
    for each in found:
        for one in each.all:
            if isinstance(one, Support):
                fixed.setdefault(one.tool.name, one)
    borne = (*(() if lowest is None else (lowest,)), *fixed.values())
    return Supports(borne, None if lowest is None else lowest.height)


def _way_down(
    free: Sequence[tuple[bpy.types.Object, DrawnBody]],
    supports: Supports,
    size: float,
    height: float,
) -> float:
    """How far all free ones may go down at once before one is at a height over what bears it."""
    placed = [(drawn, placement_of(drawn.frame)) for _, drawn in free]
    gaps = [supports.gap_beneath(place.to_world(drawn.surface_nodes)) for drawn, place in placed]
    gap = min(gaps, default=0.0)
    return gap - height if max(size, height) < gap < np.inf else 0.0


def _lying(drawn: DrawnBody, rest: Rest, floor: float | None) -> Lying:
    placement: Pose = rest.placement
    frame = frame_at(drawn.frame, placement) if drawn.body.is_free else drawn.frame
    displacements = rest.displacements()
    moved = drawn.drawn_displacement(displacements)
    return Lying(frame, (), displacements, above(drawn, frame, moved, floor), rest)
