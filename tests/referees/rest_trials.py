"""Free bodies that are dropped, pressed, pinched and lifted anyhow, and what must hold of each.

A trial is drawn from its seed. In every tick the energy, elastic and of the body's height, grows by
no more than hands put in; no place of the body sinks into the floor or leaves the rest of it; at
the end, hands gone, the body lies on the floor, which bears its weight, once it has fallen over.

What hands put in while their forces change lies between what the forces before and those after the
tick would: the latter is the more where a hand comes, the former where a body follows one that
goes, and where it slides off a hand's edge, round which a force turns by ten degrees in a tick.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, plate, sphere
from palpate.core.rest.rest import Rest
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.tests.bodies.free_shapes import free_ball, free_block

Array = NDArray[np.float64]

KINDS = ("settle", "press", "pinch", "lift")
GRAVITY = 9.81
# Of the weight times the size and of the work of hands in a tick, in which they go by 200 mm/s.
MOST_GAINED = 1e-4
# Of the size: how far the surface may be in the floor between contact points.
MOST_SUNK = 0.01
# Of the size: how far the surface may stretch.
MOST_STRETCHED = 1.5
# Of the weight, while it still rolls.
MOST_UNBORNE = 0.01
# Alone for 0.6 s, so often: what stands on an edge or a tip takes that long to fall over.
MOST_LEGS = 8
# Hands wait so high above or so far beside the body, m.
AIR = 2e-3
# And go so far in a tick at most, m.
STRIDE = 2e-4
# In so many ticks what is laid down on a floor has found all that bears it.
FOUND = 20
_HAND = plate(0.04, 0.04)


@dataclass(frozen=True)
class Outcome:
    """What became of a trial: shares of weight times size, of size, and of weight.

    Attributes
    ----------
    gained : the most energy in a tick beyond what hands put in.
    sunk : how deep the surface was in the floor at most.
    stretched : how far the surface reached over how far it does at rest.
    unborne : what of the weight the floor does not bear at the end.
    """

    gained: float
    sunk: float
    stretched: float
    unborne: float

    @property
    def holds(self) -> bool:
        """Whether nothing exploded, fell through or gained energy."""
        return (
            self.gained <= MOST_GAINED
            and self.sunk <= MOST_SUNK
            and self.stretched <= MOST_STRETCHED
            and self.unborne <= MOST_UNBORNE
        )


@cache
def shapes() -> tuple[SoftBody, ...]:
    """A cube, a bar, a flat slab and a ball."""
    return (
        free_block((0.05, 0.05, 0.05), (4, 4, 4), young_modulus=30_000.0),
        free_block((0.02, 0.03, 0.08), (2, 3, 8), young_modulus=100_000.0),
        free_block((0.06, 0.05, 0.015), (6, 5, 2), young_modulus=60_000.0),
        free_ball(0.02, 6, young_modulus=30_000.0),
    )


@dataclass(frozen=True)
class _Hands:
    """Tools where they wait, and how far from there they have gone at each tick, (t, hands, 3)."""

    tools: list[tuple[Tool, Pose]]
    way: Array


class _Trial:
    """A body on its way, and the worst so far."""

    def __init__(self, body: SoftBody) -> None:
        self.body = body
        self.size = float(np.linalg.norm(np.ptp(body.mesh.nodes, axis=0)))
        self.reach = _reach(body.mesh.nodes[body.mesh.surface_nodes])
        self.weight = body.mass * GRAVITY
        self.gained = self.sunk = self.stretched = 0.0

    def go(self, resting: Resting, hands: _Hands, seconds: float) -> Rest:
        """Hands go their way, a tick a step; the body is where it came to."""
        starts = [pose for _, pose in hands.tools]
        for _ in range(FOUND):
            rest = resting.step(seconds)
        before = np.zeros((len(starts), 3))
        for moved in hands.way:
            resting.lead(
                [Pose(s.position + by, s.rotation) for s, by in zip(starts, moved, strict=True)]
            )
            energy, pushed = self.energy(rest), _pushes(rest)
            rest = resting.step(seconds)
            by = moved - before
            put_in = max(float((pushes * by).sum()) for pushes in (pushed, _pushes(rest)))
            scale = self.weight * self.size + abs(put_in)
            self.gained = max(self.gained, (self.energy(rest) - energy - put_in) / scale)
            before = moved
            self.look(rest)
        return rest

    def energy(self, rest: Rest) -> float:
        """Elastic and of its height, J."""
        return rest.elastic + self.weight * float(rest.centre[2])

    def look(self, rest: Rest) -> None:
        """Take down how deep it is in the floor, and how far it is stretched."""
        surface = rest.surface()
        self.sunk = max(self.sunk, float(-surface[:, 2].min()) / self.size)
        self.stretched = max(self.stretched, _reach(surface) / self.reach)


def _pushes(rest: Rest) -> Array:
    """Of hands on the body, (hands, 3), N."""
    return np.array([-touch.force for touch in rest.tools]).reshape(-1, 3)


def _reach(surface: Array) -> float:
    """Of the farthest place from the mean, m."""
    return float(np.linalg.norm(surface - surface.mean(axis=0), axis=1).max())


def trial(seed: int) -> Outcome:
    """The outcome of the trial with this seed, of the kind ``KINDS[seed % 4]``."""
    random = np.random.default_rng(seed)
    body = shapes()[int(random.integers(len(shapes())))]
    rotation = Rotation.random(random_state=random).as_matrix()
    lowest = float((body.mesh.nodes @ rotation.T)[:, 2].min())
    placement = Pose.at([0.0, 0.0, 0.002 - lowest], rotation)
    floors = [Floor(friction=float(random.choice([0.0, 0.2, 0.8])))]
    settings = RestSettings(
        friction=float(random.choice([0.0, 0.3, 1.0])), drag_time=float(random.uniform(0.02, 0.1))
    )
    tried, alone = _Trial(body), _Hands([], np.zeros((150, 0, 3)))
    resting = Resting(body, floors, placement=placement, settings=settings)
    rest = tried.go(resting, alone, 1e-3)
    kind = KINDS[seed % len(KINDS)]
    if kind != "settle":
        hands = _hands(kind, random, rest.surface())
        resting = Resting(body, floors, hands.tools, placement=rest.placement, settings=settings)
        rest = tried.go(resting, hands, 1e-3)
        resting = Resting(body, floors, placement=rest.placement, settings=settings)
    for _ in range(MOST_LEGS):
        rest = tried.go(resting, alone, 4e-3)
        unborne = abs(float(-rest.supports[0].force[2]) / tried.weight - 1.0)
        if unborne <= MOST_UNBORNE:
            break
    return Outcome(tried.gained, tried.sunk, tried.stretched, unborne)


def _hands(kind: str, random: np.random.Generator, surface: Array) -> _Hands:
    """One that presses from above, or two that come from both sides."""
    if kind == "press":
        tool = sphere(float(random.uniform(0.006, 0.015))) if random.random() < 0.5 else _HAND
        high = float(surface[:, 2].max())
        depth = float(random.uniform(0.02, 0.12)) * high
        middle = surface[:, :2].mean(axis=0) + random.uniform(-0.1, 0.1, 2) * np.ptp(surface, 0)[:2]
        start = [*middle, high + AIR + (0.0 if tool is _HAND else tool.radius)]
        way = np.array([[0.0, 0.0, -AIR - depth]])
        return _Hands(
            [(tool, Pose.at(start))], _path([np.zeros((1, 3)), way, way, np.zeros((1, 3))])
        )
    turn = float(random.uniform(0.0, 2.0 * np.pi))
    axis = np.array([np.cos(turn), np.sin(turn), 0.0])
    along = surface @ axis
    squeeze = float(random.uniform(0.02, 0.12)) * float(np.ptp(along))
    middle = surface.mean(axis=0)
    tools = []
    for side, reach in ((-1.0, float(along.min())), (1.0, float(along.max()))):
        aside = np.cross([0.0, 0.0, 1.0], axis)
        looks = np.column_stack([aside, np.cross(side * axis, aside), side * axis])
        place = middle + (reach + side * AIR - middle @ axis) * axis
        tools.append((_HAND, Pose.at(place, looks)))
    closed = (AIR + 0.5 * squeeze) * np.array([axis, -axis])
    up = np.array([0.0, 0.0, float(random.uniform(0.01, 0.03)) if kind == "lift" else 0.0])
    none, away = np.zeros((2, 3)), -2.0 * AIR * np.array([axis, -axis])
    return _Hands(tools, _path([none, closed, closed + up, closed + up, away + up]))


def _path(corners: list[Array]) -> Array:
    """Places (t, hands, 3) on the way through corners, at most a stride apart, 20 a leg or more."""
    legs = []
    for start, end in pairwise(corners):
        far = float(np.linalg.norm(end - start, axis=1).max())
        steps = max(int(np.ceil(far / STRIDE)), 20)
        shares = np.arange(1, steps + 1)[:, None, None] / steps
        legs.append(start + shares * (end - start))
    return np.concatenate(legs)
