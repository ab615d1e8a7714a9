"""An object that nobody holds under a press: the servo moves it, and it is shown where it is."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose
from ...core.servo.session import Body, Prop, Snapshot
from ..object.drawn_body import DrawnBody
from ..scene.body_frame import BodyFrame
from .before import Before
from .coming_down import refuse_played, show
from .free_body import FreeBody, Lying, above, lie, supports_under
from .laid import lay, move
from .placement import frame_at, placement_of

# Share of its size by which an object that was pressed has moved: less is the servo's rounding.
MOVED = 1e-3


@dataclass(frozen=True, eq=False)
class PressedProp:
    """An object that nobody holds; made by :meth:`begin`, which moves nothing.

    Hands that press it are led in the world: it moves under them.

    Attributes
    ----------
    drawn : the body where it came to rest before.
    """

    drawn: DrawnBody
    _alone: FreeBody
    _rested: Lying
    _before: Before

    @classmethod
    def begin(cls, thing: bpy.types.Object, drawn: DrawnBody) -> PressedProp | None:
        """Let a body come to rest; None for a pinned one.

        Raises
        ------
        PalpateError
            It does not, or cannot move by itself.
        """
        if not drawn.body.is_free:
            return None
        refuse_played(thing)
        graph = bpy.context.evaluated_depsgraph_get()
        alone = lie(thing, drawn, supports_under(thing, drawn, graph), for_servo=True)
        rested = alone.come_down()
        drawn = replace(drawn, body=alone.resting.body, frame=rested.frame)
        return cls(drawn, alone, rested, Before.of(thing))

    @property
    def world(self) -> BodyFrame:
        """Frame in which hands are led, metres."""
        return replace(self.drawn.frame, rotation=np.eye(3), origin=np.zeros(3))

    @property
    def start(self) -> Pose:
        """Where the body's axes are in the world before it is pressed, metres."""
        return self._rested.rest.placement

    @property
    def air(self) -> float:
        """How far from its surface at rest it may be where it rests, metres."""
        return 2.0 * float(np.linalg.norm(self._rested.displacements, axis=1).max())

    @property
    def native(self) -> tuple[Body, Prop]:
        """The body as the servo has it, and as it is laid down there."""
        resting = self._alone.resting
        return resting.native_body, resting.laid()

    def make_ready(self, thing: bpy.types.Object) -> None:
        """Move the object to where it came to rest."""
        show([thing], [self._rested], self._alone.supports.floor)

    def give_back(self, thing: bpy.types.Object) -> None:
        """Have the object as it was before."""
        self._before.give_back(thing)

    def leave(self, thing: bpy.types.Object, drawn: DrawnBody) -> None:
        """Have the object lie where its body is now."""
        lay(thing, drawn.frame, self._alone.supports.floor)

    def follow(self, thing: bpy.types.Object, drawn: DrawnBody, snapshot: Snapshot) -> DrawnBody:
        """The body where a tick left it; the object is moved there."""
        if snapshot.tick == 0:
            return drawn
        position, rotation = snapshot.placement
        frame = frame_at(drawn.frame, Pose(np.asarray(position), np.asarray(rotation)))
        move(thing, frame)
        return replace(drawn, frame=frame)

    def has_moved(self, drawn: DrawnBody) -> bool:
        """Whether the body is elsewhere than it came to rest before."""
        now, start = placement_of(drawn.frame), self.start
        off = np.abs(now.rotation - start.rotation).max() * drawn.size
        return bool(max(off, np.abs(now.position - start.position).max()) > MOVED * drawn.size)

    def beyond_rest(self, drawn: DrawnBody, moved: NDArray[np.float32]) -> NDArray[np.float32]:
        """Displacements (3 p,) of the drawn vertices beside those by which it rested, and none of
        which leads beneath the floor.
        """
        over = above(drawn, drawn.frame, moved, self._alone.supports.floor)
        beyond: NDArray[np.float32] = over - self._rested.moved
        return beyond
