"""Push on an object that nobody holds: it gives way, slides, rolls, and comes to rest again."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.contact.place import nearest_place
from ....core.contact.tool.pose import AIR, Pose
from ....core.errors import PalpateError
from ....core.grip.patch import Grip
from ...object.drawn_body import DrawnBody
from ...rest.before import Before
from ...rest.free_body import FreeBody, Lying, lie, supports_under
from ...rest.placement import placement_of
from ...rest.settle import refuse_played, show
from .fingertips import Fingertips
from .motion import Asked, Motion
from .pushing import DEEPEST
from .stroke import MOST_SQUEEZED, Stroke
from .stroked import Stroked
from .thickness import Thickness

Array = NDArray[np.float64]

# While the pointer moves a body goes on by so many ticks, of so many seconds.
TICKS, TICK = 40, 2e-3


@dataclass(frozen=True, eq=False)
class FreeStroke:
    """Stroke on an object that nobody holds; made by :meth:`begin`, which moves nothing.

    Attributes
    ----------
    drawn : the body where it came to rest before.
    grips : the place, then its mirror images.
    rested : the body there.
    """

    drawn: DrawnBody
    grips: tuple[Grip, ...]
    rested: Lying
    _before: Before
    _free: FreeBody
    _tips: Fingertips

    @classmethod
    def begin(
        cls, thing: bpy.types.Object, drawn: DrawnBody, grips: tuple[Grip, ...]
    ) -> FreeStroke:
        """Let the body come to rest, then set fingertips down on it.

        Raises
        ------
        PalpateError
            It does not come to rest, or cannot move by itself; fingertips that do not fit.
        """
        refuse_played(thing)
        graph = bpy.context.evaluated_depsgraph_get()
        supports = supports_under(thing, drawn, graph)
        rested = lie(thing, drawn, supports).settle()
        drawn = replace(drawn, frame=rested.frame)
        tips = Fingertips.over(drawn, grips)
        if not tips.reach:
            raise PalpateError("The fingertip does not fit here; a smaller one does")
        off = 2.0 * float(np.linalg.norm(rested.displacements, axis=1).max()) + AIR * drawn.size
        starts = [_in_world(rested, tips.pose(grip, -off)) for grip in grips]
        tools = [(tips.tool, start) for start in starts]
        free = lie(thing, drawn, supports, tools, rested.rest.placement)
        free.resting.settle()
        return cls(drawn, grips, rested, Before.of(thing), free, tips)

    def make_ready(self, thing: bpy.types.Object) -> None:
        """Move the object to where it came to rest."""
        show(thing, self.rested, self._free.supports.floor)

    def give_back(self, thing: bpy.types.Object) -> None:
        """Have the object as it was before."""
        self._before.give_back(thing)

    def stroked(self, asked: Asked) -> tuple[Asked, Stroked]:
        """Where the body comes to rest under fingertips that go where they are asked to; and what
        was done of it, where it asked to go deeper than the body is thick.

        Raises
        ------
        PalpateError
            The motion is no push inward, or the body does not come to rest.
        """
        done = self._led(asked)
        try:
            lying = self._free.settle()
        except PalpateError as problem:
            raise PalpateError(DEEPEST) from problem
        return done, _stroked(lying)

    def towards(self, asked: Asked) -> tuple[Asked, Stroked]:
        """The same on the way there, as far as the body goes while a picture is drawn."""
        done = self._led(asked)
        for _ in range(TICKS):
            self._free.resting.tick(TICK, hurried=True)
        return done, _stroked(self._free.now())

    def ended(self, asked: Asked, stroked: Stroked) -> tuple[Asked, Stroked]:
        """What came of the stroke once all is at rest; as far as it went, where it never is."""
        try:
            return self.stroked(asked)
        except PalpateError:
            return asked, stroked

    def _led(self, asked: Asked) -> Asked:
        """Lead the fingertips; what is asked of them at most."""
        if asked.motion is not Motion.PUSH or math.copysign(1.0, asked.amount) < 0.0:
            raise PalpateError(
                "What nothing pins can only be pushed inward yet; choose Push, or other Pins"
            )
        done, thickness = asked, Thickness.under(self.drawn, self.grips[0])
        if thickness is not None and asked.amount > MOST_SQUEEZED * thickness.metres:
            done = replace(asked, amount=MOST_SQUEEZED * thickness.metres)
        goals = [self._goal(grip, done.amount) for grip in self._tips.places(done)]
        self._free.resting.lead(goals)
        return done

    def _goal(self, grip: Grip, depth: float) -> Pose:
        """Pose in the world of a fingertip that has gone in from where the surface came to rest."""
        pose = self._tips.pose(grip, depth)
        place = nearest_place(self.drawn.body, grip.centre(self.drawn.body.mesh))
        corners = self.drawn.body.mesh.surface_triangles[place.triangle]
        moved = place.alpha @ self.drawn.node_displacements(self.rested.displacements)[corners]
        return _in_world(self.rested, Pose(pose.position + moved, pose.rotation))


def _stroked(lying: Lying) -> Stroked:
    force = float(np.linalg.norm(lying.touches[0].force))
    return Stroked(lying.displacements, force, touches=lying.touches, lying=lying)


def _in_world(rested: Lying, pose: Pose) -> Pose:
    """Pose in the world of one in the axes of a body that rests."""
    placement = placement_of(rested.frame)
    return Pose(
        placement.rotation @ pose.position + placement.position, placement.rotation @ pose.rotation
    )


def stroke_of(
    thing: bpy.types.Object, drawn: DrawnBody, grips: tuple[Grip, ...]
) -> Stroke | FreeStroke:
    """The stroke of an object: of a pinned one, or one that nobody holds.

    Raises
    ------
    PalpateError
        As of :meth:`FreeStroke.begin`.
    """
    if drawn.body.is_free:
        return FreeStroke.begin(thing, drawn, grips)
    return Stroke(drawn, grips, thing.palpate.young_modulus, thing.palpate.static_friction)
