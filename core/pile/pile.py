"""Several soft bodies that press each other, with supports and tools, without a clock."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Pile as NativePile

from ..body.soft_body import SoftBody
from ..contact.tool.native_tool import native_shape
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from ..contact.touches import ToolTouch
from ..errors import PalpateError
from ..rest.prop import at
from ..rest.refusals import one_goal_each, rest_errors
from ..rest.rest import Rest
from ..rest.rest_settings import down
from ..rest.support import Floor, Support, friction_checked
from .felt import Felt
from .pile_settings import USUAL_PILE, PileSettings
from .touched import Touched, nearest, rigid

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import PropAmong

MOST_BODIES = 16
# Ticks so short, in seconds, that nothing moves as a whole; at most so many until the sum of all
# forces stays to this share.
INSTANT, MOST_INSTANTS, STAYS = 1e-9, 30, 1e-6


class Pile:
    """Bodies where they are, which keep what they hold in each other from call to call.

    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> from palpate.core.stiffness.pins import NoPins
    >>> settings = BakeSettings(poisson_ratio=0.3, young_modulus=1e5, pins=NoPins(), density=1000.0)
    >>> cube, _ = bake(paper_cube()[0], settings)
    >>> above = Pose.at([0.0, 0.0, 0.0505])
    >>> lower, upper = Pile([(cube, Pose.at([0.0, 0.0, 0.0])), (cube, above)], [Floor()]).settle()
    >>> round(float(upper.others[0].force[2]), 3), round(float(lower.supports[0].force[2]), 3)
    (-1.226, -2.453)

    Parameters
    ----------
    bodies : each with the placement of its frame in the world; a free one with a density moves, a
        pinned one is held where it is.
    supports : what they may rest on.
    tools : what may press them, with their poses in the world, outside of all bodies. The body
        that is nearest to one then has contact points as close as it asks for.
    fingertips : tools of a servo's fingers, which press them besides (:meth:`laid`); the same of
        the first body.

    Raises
    ------
    PalpateError
        No bodies or too many, none that is free, a free one without a density, invalid settings.
    """

    def __init__(
        self,
        bodies: Sequence[tuple[SoftBody, Pose]],
        supports: Sequence[Floor | Support] = (),
        tools: Sequence[tuple[Tool, Pose]] = (),
        *,
        fingertips: Sequence[Tool] = (),
        settings: PileSettings = USUAL_PILE,
    ) -> None:
        if not 1 <= len(bodies) <= MOST_BODIES:
            raise PalpateError(
                "{bodies} bodies in a pile; give from 1 to {most}",
                bodies=len(bodies),
                most=MOST_BODIES,
            )
        if not any(body.is_free for body, _ in bodies):
            raise PalpateError("all bodies are pinned; bake one without pins, which may move")
        by_tools = settings.friction if settings.tool_friction is None else settings.tool_friction
        friction_checked(settings.friction)
        friction_checked(by_tools)
        self.bodies = tuple(body for body, _ in bodies)
        self.firmness = (1.0,) * len(bodies)
        hands = [(nearest(bodies, pose), tool) for tool, pose in tools]
        hands += [(self.bodies[0], tool) for tool in fingertips]
        touched: dict[SoftBody, Touched] = {}
        laid = []
        for number, (body, placement) in enumerate(bodies):
            if body not in touched:
                own = [tool for of, tool in hands if of is body]
                touched[body] = Touched.of(body, own, settings.spacing)
            free = None
            if body.is_free:
                kept = settings.drag_time, number in settings.steady
                free = body.mass, body.inertia.centre, body.moments, *kept
            points = touched[body].surface, touched[body].by_hands
            laid.append((*points, body.modulus(None), free, *at(placement)))
        self._points = [touched[body].points for body in self.bodies]
        self.native_body = touched[self.bodies[0]].native
        obstacles = [
            *((native_shape(tool), *at(pose), by_tools, True) for tool, pose in tools),
            *(rigid(support, self._size()) for support in supports),
        ]
        self._tools = tuple(tool for tool, _ in tools)
        self._steady, self._down = settings.steady, down(settings.gravity)
        self._led = [pose for _, pose in tools]
        self._borne = [support.pose for support in supports]
        with rest_errors(ValueError):
            self._native = NativePile(
                laid, obstacles, gravity=settings.gravity, friction=settings.friction
            )

    def laid(self) -> PropAmong:
        """The first body among the others as they lie, for a servo on its ``native_body``, which
        goes on from here: its fingers' tools press all of them.

        Raises
        ------
        PalpateError
            The first body is pinned, tools of the pile's own, more bodies than a servo takes.
        """
        if not self.bodies[0].is_free:
            raise PalpateError("the body to be touched is pinned; name one first that is free")
        if self._led:
            raise PalpateError(
                "{tools} tools press the pile; a servo's fingers lead them, so make it without",
                tools=len(self._led),
            )
        with rest_errors(ValueError):
            return self._native.laid()

    def _size(self) -> float:
        return max(float(body.mesh.nodes.max() - body.mesh.nodes.min()) for body in self.bodies)

    def firm(self, firmness: Sequence[float]) -> None:
        """Have each body be so many times as firm as its material, from the next step on."""
        self.firmness = tuple(firmness)
        for number, modulus in enumerate(self._moduli):
            self._native.set_young_modulus(number, modulus)

    @property
    def _moduli(self) -> list[float]:
        pairs = zip(self.bodies, self.firmness, strict=True)
        return [times * body.modulus(None) for body, times in pairs]

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals, one each, from the next step on."""
        one_goal_each(goals, self._led)
        self._led = list(goals)
        for number, goal in enumerate(goals):
            self._native.lead(number, *at(goal))

    def move_support(self, number: int, pose: Pose) -> None:
        """Have a support go elsewhere from the next step on, as tools do."""
        self._borne[number] = pose
        self._native.lead(len(self._led) + number, *at(pose))

    def come_in(self) -> None:
        """Have what overlaps press each other while all stay where they are: so bodies that rested
        before go on from there, instead of being driven apart.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        before = np.inf
        for _ in range(MOST_INSTANTS):
            self.tick(INSTANT)
            now = float(np.abs(self._native.contacts()["force"]).sum())
            if abs(now - before) <= STAYS * now:
                return
            before = now

    def step(self, seconds: float = 1e-3) -> tuple[Rest, ...]:
        """Go on by a tick, in which each tool goes by a stride at most: where each body is then.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        self.tick(seconds)
        return self.rests

    def tick(self, seconds: float = 1e-3) -> None:
        """The same without telling where the bodies are.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        with rest_errors(ValueError, RuntimeError):
            self._native.tick(seconds)

    def hurry(self, seconds: float) -> None:
        """The same, with all the work that it takes."""
        self.tick(seconds)

    def settle(self) -> tuple[Rest, ...]:
        """Go on until tools are at their goals, wrenches on all bodies cancel and nothing changes.

        Raises
        ------
        PalpateError
            A body does not come to rest: it falls, slides or rolls without end.
        """
        with rest_errors(RuntimeError):
            self._native.settle()
        return self.rests

    def settle_on(self, ticks: int) -> bool:
        """Go on with settling by so many ticks at most; whether all rest.

        Raises
        ------
        PalpateError
            As of :meth:`settle`.
        """
        with rest_errors(RuntimeError):
            return self._native.settle_on(ticks)

    def tool_touches(self, body: int) -> tuple[ToolTouch, ...]:
        """Touches of the tools with a body, in its own frame."""
        contacts = self._native.contacts()
        felt = Felt(body, self.bodies[body], self._points[body], self.placements[body], contacts)
        led = enumerate(zip(self._tools, self._led, strict=True))
        return tuple(felt.of_tool(number, tool, pose) for number, (tool, pose) in led)

    def _let_go(self, number: int, placement: Pose) -> NDArray[np.float64] | None:
        return self._down @ placement.rotation if number in self._steady else None

    @property
    def placements(self) -> list[Pose]:
        """Where the frame of each body is in the world."""
        native, count = self._native, len(self.bodies)
        return [Pose(native.position(body), native.rotation(body)) for body in range(count)]

    @property
    def rests(self) -> tuple[Rest, ...]:
        """Where each body is now, and what touches it: tools, supports, and all other bodies by
        their numbers, its own among them, which never does.
        """
        native, count, placements = self._native, len(self.bodies), self.placements
        contacts, moduli = native.contacts(), self._moduli
        rests = []
        for number, body in enumerate(self.bodies):
            felt = Felt(number, body, self._points[number], placements[number], contacts)
            led = len(self._led)
            rests.append(
                Rest(
                    body,
                    placements[number],
                    tuple(felt.of_obstacle(tool, pose) for tool, pose in enumerate(self._led)),
                    tuple(
                        felt.of_obstacle(led + support, pose)
                        for support, pose in enumerate(self._borne)
                    ),
                    native.elastic(number),
                    native.time,
                    moduli[number],
                    tuple(felt.of_body(other, placements[other]) for other in range(count)),
                    let_go=self._let_go(number, placements[number]),
                )
            )
        return tuple(rests)
