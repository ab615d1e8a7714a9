"""Presses of bodies that nobody holds: what presses them, what bears them, how deep it goes.

Without friction a body lies still under what is flat, and slips aside under what is not. So under
that it lies on a rough floor, or in a tray, with smooth walls at its sides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.hands import Hand, ball, edged, lying_rod, wall
from palpate.core.body.soft_body import SoftBody
from palpate.core.rest.support import Floor

Array = NDArray[np.float64]
Made = Callable[[Array, Array], Hand]

# Over the edge of a surface's triangles, and over a body's height.
BALL_EDGES, ROD_RADIUS = 2.4, 0.2
BALL_DEPTHS, ROD_DEPTHS, WALL_DEPTHS = (0.5, 0.75, 1.0), (0.5, 1.0), (0.1, 0.2, 0.4)
DEEPEST = 0.4  # of the thickness, what a round tool goes in at most
DOWN = np.array([0.0, 0.0, -1.0])
ROUGH = 0.5
# On the top, over its size: its middle, and aside.
MIDDLE, BESIDE = np.array([0.5, 0.5]), np.array([0.36, 0.36])
# What looks the same from all sides only walls hold; what is uneven only lies under them.
BODIES = ("cube", "bar", "mouse-1.7k", "drumstick", "ball")
FLAT = ("cube", "bar")


@dataclass(frozen=True, eq=False)
class Depth:
    """How deep hands go.

    Attributes
    ----------
    way : of each, metres.
    radii : over the radius of the tool, 0 of a flat one.
    share : of the part's thickness.
    """

    way: float
    radii: float
    share: float

    @property
    def is_near(self) -> bool:
        """By half a radius, or a fifth of the part, at most."""
        return self.radii <= 0.5 and self.share <= 0.2


@dataclass(frozen=True, eq=False)
class Press:
    """Hands that go in, one depth after another.

    Attributes
    ----------
    name : of it.
    inward : (3,), the way of the first hand, unit.
    hands : at a depth in metres; negative before the body.
    floors : that bear the body.
    depths : one after another.
    """

    name: str
    inward: Array
    hands: Callable[[float], tuple[Hand, ...]]
    floors: tuple[Floor, ...]
    depths: tuple[Depth, ...]


def presses_of(name: str, body: SoftBody, edge: float) -> Iterator[Press]:
    """All presses of a body of :data:`BODIES`; ``edge`` is that of its triangles, metres."""
    box = Box.around(body)
    yield box.by_wall()
    yield box.pinched_by_walls()
    if name not in FLAT:
        return
    radius, thick, long = BALL_EDGES * edge, ROD_RADIUS * box.size[2], 4.0 * box.size[1]
    round_one = partial(ball, radius=radius)
    yield box.from_above("ball", round_one, radius, BALL_DEPTHS)
    yield box.from_above("ball beside", round_one, radius, BALL_DEPTHS, place=BESIDE)
    yield box.from_above("ball, in a tray", round_one, radius, BALL_DEPTHS, tray=True)
    lying = partial(lying_rod, radius=thick, length=long)
    yield box.from_above("rod", lying, thick, ROD_DEPTHS)
    sharp = partial(edged, width=2.0 * thick, length=long)
    yield box.from_above("edge of a block", sharp, thick, ROD_DEPTHS)
    yield box.pinched_by_balls(radius)


@dataclass(frozen=True, eq=False)
class Box:
    """About a body: two corners (3,), metres."""

    low: Array
    high: Array

    @classmethod
    def around(cls, body: SoftBody) -> Box:
        """About its nodes."""
        return cls(body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0))

    @property
    def size(self) -> Array:
        """Its edges, (3,)."""
        return self.high - self.low

    def by_wall(self) -> Press:
        """A wall from above, on a smooth floor."""

        def hands(way: float) -> tuple[Hand, ...]:
            return (wall(self._top(MIDDLE) + way * DOWN, DOWN, self._wide),)

        depths = tuple(Depth(share * self.size[2], 0.0, share) for share in WALL_DEPTHS)
        return Press("wall", DOWN, hands, (self._floor(DOWN),), depths)

    def pinched_by_walls(self) -> Press:
        """Two walls, and no floor; along the shorter side of those that lie."""
        inward, through = self._shorter
        made = partial(wall, size=self._wide)
        depths = tuple(Depth(0.5 * share * through, 0.0, share) for share in WALL_DEPTHS)
        return Press("pinched by walls", inward, partial(self._pinching, made), (), depths)

    def pinched_by_balls(self, radius: float) -> Press:
        """Two balls along the shorter side of those that lie, in a tray that is open there."""
        inward, through = self._shorter
        across = [axis for axis in np.eye(3) if not axis @ inward]
        tray = tuple(self._floor(sign * axis) for axis in across for sign in (-1.0, 1.0))
        hands = partial(self._pinching, partial(ball, radius=radius))
        depths = self._depths(BALL_DEPTHS, radius, through / 2.0)
        return Press("pinched by balls, in a tray", inward, hands, tray, depths)

    def from_above(
        self,
        name: str,
        made: Made,
        radius: float,
        depths: tuple[float, ...],
        *,
        place: Array = MIDDLE,
        tray: bool = False,
    ) -> Press:
        """A round tool from above, on a rough floor or in a tray."""

        def hands(way: float) -> tuple[Hand, ...]:
            return (made(self._top(place) + way * DOWN, DOWN),)

        aside = [sign * axis for axis in np.eye(3)[:2] for sign in (-1.0, 1.0)]
        smooth = tuple(self._floor(way) for way in (DOWN, *aside))
        floors = smooth if tray else (self._floor(DOWN, ROUGH),)
        return Press(name, DOWN, hands, floors, self._depths(depths, radius, self.size[2]))

    def _pinching(self, made: Made, way: float) -> tuple[Hand, ...]:
        inward, through = self._shorter
        middle = 0.5 * (self.low + self.high)
        return tuple(made(middle - (through / 2.0 - way) * one, one) for one in (inward, -inward))

    def _depths(
        self, shares: tuple[float, ...], radius: float, through: float
    ) -> tuple[Depth, ...]:
        found = [Depth(share * radius, share, share * radius / through) for share in shares]
        return tuple(depth for depth in found if depth.share <= DEEPEST)

    def _top(self, place: Array) -> Array:
        return np.append(self.low[:2] + place * self.size[:2], self.high[2])

    def _floor(self, outward: Array, friction: float = 0.0) -> Floor:
        """Against the side that looks along ``outward`` (3,), an axis."""
        side = np.where(outward > 0.0, self.high, self.low)
        x, y, z = -outward
        return Floor(-float(side @ outward), friction, (x, y, z))

    @property
    def _shorter(self) -> tuple[Array, float]:
        """The shorter of the sides that lie, as a direction (3,) and a length."""
        axis = int(self.size[:2].argmin())
        return np.eye(3)[axis], float(self.size[axis])

    @property
    def _wide(self) -> float:
        return 3.0 * float(self.size.max())
