"""Free bodies that are dropped, pressed, pinched and lifted anyhow, and what must hold of each.

A trial is drawn from its seed. In every tick the energy, elastic and of the body's height, grows by
no more than hands put in; no place of the body sinks into the floor or leaves the rest of it; at
the end, hands gone, the body lies on the floor, which bears its weight, once it has fallen over.

What hands put in while their forces change lies between what the forces before and those after the
tick would: the latter is the more where a hand comes, the former where a body follows one that
goes, and where it slides off a hand's edge, round which a force turns by ten degrees in a tick.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, plate, sphere
from palpate.core.pile.pile import Pile
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
class Hands:
    """Tools where they wait, and how far from there they have gone at each tick, (t, hands, 3)."""

    tools: list[tuple[Tool, Pose]]
    way: Array


# No hands, for so many ticks.
ALONE = Hands([], np.zeros((150, 0, 3)))


class Trial:
    """Bodies on their way, and the worst so far."""

    def __init__(self, bodies: Sequence[SoftBody]) -> None:
        self.sizes = [float(np.linalg.norm(np.ptp(body.mesh.nodes, axis=0))) for body in bodies]
        self.reaches = [_reach(body.mesh.nodes[body.mesh.surface_nodes]) for body in bodies]
        self.weights = [body.mass * GRAVITY for body in bodies]
        self.gained = self.sunk = self.stretched = 0.0

    def go(self, moving: Resting | Pile, hands: Hands, seconds: float) -> tuple[Rest, ...]:
        """Hands go their way, a tick a step; each body is where it came to."""
        starts = [pose for _, pose in hands.tools]
        for _ in range(FOUND):
            rests = _step(moving, seconds)
        before = np.zeros((len(starts), 3))
        for moved in hands.way:
            moving.lead(
                [Pose(s.position + by, s.rotation) for s, by in zip(starts, moved, strict=True)]
            )
            energy, pushed = self.energy(rests), _pushes(rests)
            rests = _step(moving, seconds)
            by = moved - before
            put_in = max(float((pushes * by).sum()) for pushes in (pushed, _pushes(rests)))
            scale = sum(self.weights) * max(self.sizes) + abs(put_in)
            self.gained = max(self.gained, (self.energy(rests) - energy - put_in) / scale)
            before = moved
            self.look(rests)
        return rests

    def energy(self, rests: Sequence[Rest]) -> float:
        """Elastic and of their heights, J."""
        raised = zip(self.weights, rests, strict=True)
        return sum(rest.elastic + weight * float(rest.centre[2]) for weight, rest in raised)

    def look(self, rests: Sequence[Rest]) -> None:
        """Take down how deep they are in the floor, and how far they are stretched."""
        for rest, size, reach in zip(rests, self.sizes, self.reaches, strict=True):
            surface = rest.surface()
            self.sunk = max(self.sunk, float(-surface[:, 2].min()) / size)
            self.stretched = max(self.stretched, _reach(surface) / reach)

    def left_alone(self, moving: Resting | Pile) -> tuple[tuple[Rest, ...], float]:
        """Without hands, until the floor bears all: each body then, and what of the weight of all
        the floor does not bear, as a share.
        """
        for _ in range(MOST_LEGS):
            rests = self.go(moving, ALONE, 4e-3)
            borne = -sum(float(rest.supports[0].force[2]) for rest in rests)
            unborne = abs(borne / sum(self.weights) - 1.0)
            if unborne <= MOST_UNBORNE:
                break
        return rests, unborne


def _step(moving: Resting | Pile, seconds: float) -> tuple[Rest, ...]:
    told = moving.step(seconds)
    return told if isinstance(told, tuple) else (told,)


def _pushes(rests: Sequence[Rest]) -> Array:
    """Of hands on all bodies, (hands, 3), N."""
    pushes = [[-touch.force for touch in rest.tools] for rest in rests]
    return np.array(pushes).reshape(len(rests), -1, 3).sum(axis=0)


def _reach(surface: Array) -> float:
    """Of the farthest place from the mean, m."""
    return float(np.linalg.norm(surface - surface.mean(axis=0), axis=1).max())


def trial(seed: int, *, steady: bool = False) -> Outcome:
    """The outcome of the trial with this seed, of the kind ``KINDS[seed % 4]``; ``steady`` where
    one more hand keeps the body from sliding and turning, which takes no work.
    """
    random = np.random.default_rng(seed)
    body = shapes()[int(random.integers(len(shapes())))]
    rotation = Rotation.random(random_state=random).as_matrix()
    lowest = float((body.mesh.nodes @ rotation.T)[:, 2].min())
    placement = Pose.at([0.0, 0.0, 0.002 - lowest], rotation)
    floors = [Floor(friction=float(random.choice([0.0, 0.2, 0.8])))]
    settings = RestSettings(
        friction=float(random.choice([0.0, 0.3, 1.0])), drag_time=float(random.uniform(0.02, 0.1))
    )
    tried = Trial([body])
    resting = Resting(body, floors, placement=placement, settings=settings)
    (rest,) = tried.go(resting, ALONE, 1e-3)
    kind = KINDS[seed % len(KINDS)]
    if kind != "settle":
        hands = hands_for(kind, random, rest.surface())
        held = replace(settings, steady=steady)
        resting = Resting(body, floors, hands.tools, placement=rest.placement, settings=held)
        (rest,) = tried.go(resting, hands, 1e-3)
        resting = Resting(body, floors, placement=rest.placement, settings=settings)
    _, unborne = tried.left_alone(resting)
    return Outcome(tried.gained, tried.sunk, tried.stretched, unborne)


def hands_for(kind: str, random: np.random.Generator, surface: Array) -> Hands:
    """One that presses from above, or two that come from both sides."""
    if kind == "press":
        tool = sphere(float(random.uniform(0.006, 0.015))) if random.random() < 0.5 else _HAND
        high = float(surface[:, 2].max())
        depth = float(random.uniform(0.02, 0.12)) * high
        middle = surface[:, :2].mean(axis=0) + random.uniform(-0.1, 0.1, 2) * np.ptp(surface, 0)[:2]
        start = [*middle, high + AIR + (0.0 if tool is _HAND else tool.radius)]
        way = np.array([[0.0, 0.0, -AIR - depth]])
        return Hands(
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
    return Hands(tools, _path([none, closed, closed + up, closed + up, away + up]))


def _path(corners: list[Array]) -> Array:
    """Places (t, hands, 3) on the way through corners, at most a stride apart, 20 a leg or more."""
    legs = []
    for start, end in pairwise(corners):
        far = float(np.linalg.norm(end - start, axis=1).max())
        steps = max(int(np.ceil(far / STRIDE)), 20)
        shares = np.arange(1, steps + 1)[:, None, None] / steps
        legs.append(start + shares * (end - start))
    return np.concatenate(legs)
