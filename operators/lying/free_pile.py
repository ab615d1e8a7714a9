"""Bodies of several objects that press each other, among what these rest on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tool_dent import PressingTool
from ...core.contact.tool.tools import Tool
from ...core.contact.touches import ToolTouch
from ...core.errors import PalpateError
from ...core.pile.pile import Pile
from ...core.pile.pile_settings import PileSettings
from ...core.rest.rest import Rest
from ...core.rest.support import Floor, Support
from ...core.servo.session import Body, PropAmong
from ...core.shape.firm_rest import FirmRest
from ..object.drawn_body import DrawnBody
from ..shape.drawn_shape import kept_shape
from .free_body import Lying, chosen_body, supports_under
from .placement import frame_at, placement_of
from .standing import scene_gravity
from .supports import Supports


@dataclass(frozen=True, eq=False)
class FreePile:
    """Bodies of objects that press each other; made by :func:`piled`.

    Attributes
    ----------
    drawn : the bodies, and their objects as they were at first.
    supports : what all rest on.
    firm : their equilibrium, by their laws.
    bodies : the same at the objects' densities and Young's moduli.
    """

    drawn: tuple[DrawnBody, ...]
    supports: Supports
    firm: FirmRest[Pile]
    bodies: tuple[SoftBody, ...]
    _settings: PileSettings

    @property
    def pile(self) -> Pile:
        """The linear bodies that press back as they do."""
        return self.firm.lying

    @property
    def size(self) -> float:
        """Diagonal of the smallest body, metres."""
        return min(drawn.size for drawn in self.drawn)

    @property
    def rest(self) -> Rest:
        """Where the first one is now, and what touches it."""
        return self.firm.rests[0]

    @property
    def native(self) -> tuple[Body, PropAmong]:
        """The first one as a servo has it, and as it is laid down among the others there.

        Raises
        ------
        PalpateError
            It is pinned, or they are more than a servo takes.
        """
        return self.pile.native_body, self.pile.laid()

    @property
    def placements(self) -> list[Pose]:
        """Where each body's frame is in the world."""
        return self.pile.placements

    def touched_by(
        self,
        tools: Sequence[tuple[Tool, Pose]],
        placements: Sequence[Pose] | None = None,
        supports: Supports | None = None,
    ) -> FreePile:
        """The same bodies where they are, or at other placements, pressed by tools whose poses are
        in the world, perhaps on other supports.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        borne = self.supports if supports is None else supports
        here = self.placements if placements is None else placements
        laid = list(zip(self.bodies, here, strict=True))
        pile = Pile(laid, borne.all, tools, settings=self._settings)
        pile.firm(self.pile.firmness)
        pile.come_in()
        return replace(self, supports=borne, firm=FirmRest(pile, self.firm.shapes))

    def take_in_hand(self) -> None:
        """Somebody leads what presses them, and looks on."""
        self.firm.in_hand = True

    def close(self) -> None:
        """End what goes on in the background."""
        self.firm.close()

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals."""
        self.firm.lead(goals)

    def touches(self) -> tuple[ToolTouch, ...]:
        """Of the tools with the first one, in its own axes."""
        return self.pile.tool_touches(0)

    def tick(self, seconds: float) -> None:
        """Go on by a tick.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        self.firm.hurry(seconds)

    def settle(self) -> list[Lying]:
        """Where they come to rest, one after the other.

        Raises
        ------
        PalpateError
            They do not.
        """
        self.firm.settle()
        return self.now()

    def settle_on(self, ticks: int) -> bool:
        """Go on with that by so many ticks at most; whether all rest.

        Raises
        ------
        PalpateError
            They do not.
        """
        return self.firm.settle_on(ticks)

    def now(self, bent: NDArray[np.float64] | None = None) -> list[Lying]:
        """Where they are now; ``bent`` (n, 3) displaces the free surface nodes of the first one
        besides, metres.
        """
        bends = [bent, *[None] * (len(self.drawn) - 1)]
        return [
            self._lying(number, rest, one)
            for number, (rest, one) in enumerate(zip(self.firm.rests, bends, strict=True))
        ]

    def _lying(self, number: int, rest: Rest, bent: NDArray[np.float64] | None) -> Lying:
        drawn = self.drawn[number]
        frame = frame_at(drawn.frame, rest.placement) if drawn.body.is_free else drawn.frame
        touches = self.pile.tool_touches(number)
        displacements = rest.displacements()
        if bent is not None:
            displacements = displacements + bent
        pressing = [PressingTool(one.tool, one.pose, one.force) for one in touches if one.touching]
        moved = drawn.drawn_displacement(displacements, pressing)
        shown = self.supports.keep_out(drawn, frame, moved)
        return Lying(frame, touches, displacements, shown, rest)


def piled(
    things: Sequence[bpy.types.Object],
    opened: Sequence[DrawnBody],
    graph: bpy.types.Depsgraph,
    height: float | None = None,
    fingertips: Sequence[Tool] = (),
    *,
    steady: bool = False,
) -> FreePile:
    """Bodies of objects where these are, with the floor and colliders of all; where nothing is
    near beneath, down at a ``height`` over it, a share of the smallest one's size, if there is one.
    ``fingertips`` are those of a servo which will press them. A hand keeps the first ``steady``.

    Friction between them is the first one's, and so is that of tools; the floor the lowest of
    theirs.

    Raises
    ------
    PalpateError
        One cannot move by itself, nothing bears any, all are pinned, or they are too many.
    """
    supports = supports_of_all(things, opened, graph)
    free = [drawn for drawn in opened if drawn.body.is_free]
    gravity = scene_gravity(graph.scene)
    down = 0.0
    # A pinned one may be on the way.
    is_clear = len(free) == len(opened) and gravity[:2] == (0.0, 0.0) and gravity[2] < 0.0
    if height is not None and is_clear:
        size = min(drawn.size for drawn in opened)
        down = _way_down(free, supports, size, height * size)
    bodies, placements = [], []
    for thing, drawn in zip(things, opened, strict=True):
        placement = placement_of(drawn.frame)
        if drawn.body.is_free:
            placement = replace(placement, position=placement.position - [0.0, 0.0, down])
        placements.append(placement)
        chosen = thing.palpate
        bodies.append(chosen_body(drawn.body, chosen.density, chosen.young_modulus))
    first = things[0].palpate
    settings = PileSettings(
        friction=first.rest_friction,
        tool_friction=first.static_friction,
        gravity=gravity,
        steady=(0,) if steady else (),
    )
    laid = list(zip(bodies, placements, strict=True))
    pile = Pile(laid, supports.all, fingertips=fingertips, settings=settings)
    pile.come_in()
    shapes = [kept_shape(thing, drawn) for thing, drawn in zip(things, opened, strict=True)]
    for shape, drawn in zip(shapes, opened, strict=True):
        shape.wait_for(drawn.body.mesh.surface_nodes[:1])
    return FreePile(tuple(opened), supports, FirmRest(pile, shapes), tuple(bodies), settings)


def supports_of_all(
    things: Sequence[bpy.types.Object], opened: Sequence[DrawnBody], graph: bpy.types.Depsgraph
) -> Supports:
    """What objects rest on as a graph has it, besides each other.

    Raises
    ------
    PalpateError
        One cannot move by itself, or nothing bears any.
    """
    found = [
        supports_under(thing, drawn, graph, besides=things)
        for thing, drawn in zip(things, opened, strict=True)
        if drawn.body.is_free
    ]
    supports = _all_of(found)
    if not supports.all and len(found) == len(opened):
        raise PalpateError(
            "{name}: there is nothing under it; choose a floor or colliders under Rests On",
            name=things[0].name,
        )
    return supports


def _all_of(found: Sequence[Supports]) -> Supports:
    """Colliders of all, each once, and the lowest of their floors."""
    floors = [one for each in found for one in each.all if isinstance(one, Floor)]
    lowest = min(floors, key=lambda floor: floor.height, default=None)
    fixed: dict[tuple[str, int], Support] = {}
    for each in found:
        # The parts of a hollow one have its name.
        parts: Counter[str] = Counter()
        for one in each.all:
            if isinstance(one, Support):
                name = one.tool.name
                fixed.setdefault((name, parts[name]), one)
                parts[name] += 1
    borne = (*(() if lowest is None else (lowest,)), *fixed.values())
    return Supports(borne, None if lowest is None else lowest.height)


def _way_down(free: Sequence[DrawnBody], supports: Supports, size: float, height: float) -> float:
    """How far all free ones may go down at once before one is at a height over what bears it."""
    gaps = [
        supports.gap_beneath(placement_of(drawn.frame).to_world(drawn.surface_nodes))
        for drawn in free
    ]
    gap = min(gaps, default=0.0)
    return gap - height if max(size, height) < gap < np.inf else 0.0
