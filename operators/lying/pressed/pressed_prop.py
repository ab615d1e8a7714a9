"""An object that nobody holds under a press: the servo moves it and those that it presses, and all
are shown where they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.contact.tool.pose import Pose
from ....core.contact.tool.tools import Tool
from ....core.rest.support import Floor, Support
from ....core.servo.session import MOST_BODIES, Body, Prop, PropAmong, Snapshot
from ...object.drawn_body import DrawnBody, open_body
from ...place.touched_place import TouchedPlace
from ...scene.body_frame import BodyFrame
from ..before import Before
from ..coming_down import Alone, lying_bodies, show
from ..free_body import Lying
from ..free_pile import FreePile
from ..laid import lay, move
from ..placement import apart, frame_at, placement_of
from ..standing import LANDING
from ..together import together
from .neighbour import MOVED, Neighbour, neighbour

# Beyond this share of its size a place is seen elsewhere than it lies: layers move it.
ELSEWHERE = 2e-3


@dataclass(frozen=True, eq=False)
class PressedProp:
    """An object that nobody holds; made by :meth:`begin`, which moves nothing.

    Hands that press it are led in the world: it moves under them.

    Attributes
    ----------
    drawn : the body where it came to rest before.
    others : soft objects that it rests on.
    """

    drawn: DrawnBody
    others: tuple[Neighbour, ...]
    _coming: Alone | FreePile
    _rested: Lying
    _before: Before

    @classmethod
    def begin(
        cls,
        thing: bpy.types.Object,
        drawn: DrawnBody,
        tool: Tool | None,
        chosen: Sequence[bpy.types.Object] = (),
    ) -> PressedProp | None:
        """Let a body come to rest with soft ones that it rests on and others ``chosen``; None for
        a pinned one.

        Points are not felt among others: without a ``tool`` these stay as they are, and so do those
        for which a servo has no room.

        Raises
        ------
        PalpateError
            It does not, or cannot move by itself.
        """
        if not drawn.body.is_free:
            return None
        graph = bpy.context.evaluated_depsgraph_get()
        things = [thing] if tool is None else together(thing, chosen)[:MOST_BODIES]
        opened = [drawn, *(open_body(one, graph.scene) for one in things[1:])]
        fingertips = () if tool is None else (tool,)
        steady = thing.palpate.steady
        coming = lying_bodies(things, opened, graph, LANDING, fingertips=fingertips, steady=steady)
        rested, *lying = coming.settle()
        first, *bodies = coming.bodies
        others = zip(things[1:], opened[1:], bodies, lying, strict=True)
        return cls(
            replace(drawn, body=first, frame=rested.frame),
            tuple(neighbour(*other, coming.supports) for other in others),
            coming,
            rested,
            Before.of(thing),
        )

    @property
    def world(self) -> BodyFrame:
        """Frame in which hands are led, metres."""
        return replace(self.drawn.frame, rotation=np.eye(3), origin=np.zeros(3))

    def hand(self, place: TouchedPlace) -> BodyFrame:
        """The world as a hand has it that presses a place: moved and turned to where that is seen,
        if layers show it elsewhere than the body has it.
        """
        own = self.drawn.frame
        (sagged,) = self.drawn.surface_displacements(self._rested.displacements, place.rest[None])
        lies = place.rest + sagged
        if np.linalg.norm(place.seen - lies) <= ELSEWHERE * self.drawn.size:
            return self.world
        seen = own.posed(place.turn, lies, place.seen)
        rotation = seen.rotation @ own.rotation.T
        return replace(self.world, rotation=rotation, origin=seen.origin - rotation @ own.origin)

    @property
    def start(self) -> Pose:
        """Where the body's axes are in the world before it is pressed, metres."""
        return self._rested.rest.placement

    @property
    def air(self) -> float:
        """How far from its surface at rest it may be where it rests, metres."""
        return 2.0 * float(np.linalg.norm(self._rested.displacements, axis=1).max())

    @property
    def supports(self) -> Sequence[Floor | Support]:
        """All that bears the body, where no other soft one does."""
        return self._coming.supports.all if isinstance(self._coming, Alone) else ()

    @property
    def let_go(self) -> NDArray[np.float64] | None:
        """Direction in the world in which alone a hand that steadies it lets it go."""
        rest = self._rested.rest
        return None if rest.let_go is None else rest.placement.rotation @ rest.let_go

    @property
    def native(self) -> tuple[Body, Prop | PropAmong]:
        """The body as the servo has it, and as it is laid down there."""
        return self._coming.native

    def make_ready(self, thing: bpy.types.Object) -> None:
        """Move all objects to where they came to rest."""
        pairs = [(thing, self._rested)]
        pairs += [
            (found, other.rested)
            for other in self.others
            if (found := other.handle.find()) is not None
        ]
        show([one for one, _ in pairs], [lying for _, lying in pairs], self._coming.supports.floor)

    def give_back(self, thing: bpy.types.Object) -> None:
        """Have all objects as they were before."""
        self._before.give_back(thing)
        for other in self.others:
            other.give_back()

    def leave(self, thing: bpy.types.Object, drawn: DrawnBody) -> None:
        """Have the object lie where its body is now; the others do."""
        lay(thing, drawn.frame, self._coming.supports.floor)

    def follow(self, thing: bpy.types.Object, drawn: DrawnBody, snapshot: Snapshot) -> DrawnBody:
        """The body where a tick left it; all objects are moved there."""
        if snapshot.tick == 0:
            return drawn
        told = zip(self.others, snapshot.others, snapshot.other_loads, strict=False)
        for other, placement, load in told:
            other.follow(_pose(placement), load)
        frame = frame_at(drawn.frame, _pose(snapshot.placement))
        move(thing, frame)
        return replace(drawn, frame=frame)

    def has_moved(self, drawn: DrawnBody) -> bool:
        """Whether a body is elsewhere than it came to rest before."""
        moved = apart(placement_of(drawn.frame), self.start, drawn.size) > MOVED
        return moved or any(other.has_moved for other in self.others)

    def beyond_rest(self, drawn: DrawnBody, moved: NDArray[np.float32]) -> NDArray[np.float32]:
        """Displacements (3 p,) of the drawn vertices beside those by which it rested, none of which
        leads into what bears it.
        """
        shown = self._coming.supports.keep_out(drawn, drawn.frame, moved)
        beyond: NDArray[np.float32] = shown - self._rested.moved
        return beyond


def _pose(told: tuple[NDArray[np.float64], NDArray[np.float64]]) -> Pose:
    position, rotation = told
    return Pose(np.asarray(position), np.asarray(rotation))
