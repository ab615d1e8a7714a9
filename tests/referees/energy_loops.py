"""Closed paths of fingers in a body, and the work that goes round them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[np.float64]
Follow = Callable[[Vectors], tuple[Vectors, Vectors]]

# Rounds are at most so many depths wide: wider ones leave the body as a rule.
WIDEST = 3.0
# Share of loops that begin on an edge or a node of the mesh.
ON_BORDERS = 0.5
# Ticks of a way in, and of a round.
PRESS = 200
ROUND = 1600
# Ticks at rest before the first round and after the last one.
REST = 20
# Contact points that differ by so many depths, and forces by such a share of themselves, are the
# same: what is stored then differs by less than a thousandth of F d / 2.
SAME = 5e-4
# Less than so many depths under the surface is not pressed in but led along it, by rounding.
GRAZED = 1e-9
# Fingers of a pair begin at most so many depths apart.
APART = 4.0


@dataclass(frozen=True)
class Span:
    """How deep loops go in, and how wide they are.

    Attributes
    ----------
    unit : metres; None for the edge of the mesh.
    depths, radii : least and largest, in that unit.
    """

    unit: float | None = None
    depths: tuple[float, float] = (0.1, 4.0)
    radii: tuple[float, float] = (0.1, 4.0)


@dataclass(frozen=True)
class Loop:
    """A way in from the air, along a normal, and a round that begins and ends there.

    Attributes
    ----------
    depth : metres.
    normal : (3,), out of the body where the way goes in.
    press : (k, 3), metres.
    round : (n, 3), metres; the last place is the first one.
    """

    depth: float
    normal: Vectors
    press: Vectors
    round: Vectors

    @property
    def path(self) -> Vectors:
        """In, at rest, round twice, at rest, and out as it came, (ticks, 3)."""
        begin = np.repeat(self.round[:1], REST, axis=0)
        rounds = (self.round[1:], self.round[1:])
        return np.concatenate([self.press, begin, *rounds, begin, self.press[::-1]])


@dataclass(frozen=True)
class Books:
    """What fingers were given on their loops, as shares of F d / 2: of the finger for which that is
    most, its largest force and the depth of its press.

    Attributes
    ----------
    rounds : energy that came out of each round. Only of those that touched throughout, and whose
        contact points and forces ended as they began: past a ridge one may lie on the other side,
        where less of what the press has put in is held, and tools may go round by two ways in turn.
    path : of the whole path, from air to air.
    """

    rounds: tuple[float, ...]
    path: float


def random_loops(
    nodes: Vectors,
    triangles: NDArray[np.int64],
    free: NDArray[np.bool_],
    count: int,
    seed: int,
    span: Span = Span(),
) -> Iterator[Loop]:
    """Ellipses in any plane, at any place of a surface whose triangles are free to move.

    ``nodes`` (n, 3) in metres, ``triangles`` (t, 3), ``free`` (n,).
    """
    random = np.random.default_rng(seed)
    triangles = triangles[free[triangles].all(axis=1)]
    a, b, c = (nodes[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    normals /= areas[:, None]
    unit = span.unit or float(np.sqrt(2.0 / np.sqrt(3.0) * np.median(areas)))
    angle = np.linspace(0.0, 2.0 * np.pi, ROUND + 1)[:, None]
    for _ in range(count):
        triangle = random.choice(len(triangles), p=areas / areas.sum())
        alpha = random.dirichlet(np.ones(3))
        if random.random() < ON_BORDERS:
            alpha *= random.permutation([1.0, random.integers(2), 0.0])
            alpha /= alpha.sum()
        depth = unit * np.exp(random.uniform(*np.log(span.depths)))
        wide = min(unit * np.exp(random.uniform(*np.log(span.radii))), WIDEST * depth)
        narrow = wide * random.uniform(0.3, 1.0)
        plane = np.linalg.qr(random.normal(size=(3, 3)))[0]
        start = alpha @ nodes[triangles[triangle]] - depth * normals[triangle]
        heights = np.linspace(1.05 * depth, 0.0, PRESS)[:, None]
        ellipse = (1.0 - np.cos(angle)) * plane[0] * wide + np.sin(angle) * plane[1] * narrow
        ellipse[-1] = 0.0
        normal = normals[triangle]
        yield Loop(float(depth), normal, start + heights * normal, start + 0.5 * ellipse)


def random_pairs(loops: Sequence[Loop], seed: int) -> Iterator[tuple[Loop, Loop]]:
    """Each loop with another one that begins nearby, if there is one."""
    random = np.random.default_rng(seed)
    starts = np.array([loop.round[0] for loop in loops])
    for number, loop in enumerate(loops):
        distances = np.linalg.norm(starts - starts[number], axis=1)
        near = np.flatnonzero(distances < APART * loop.depth)
        others = near[near != number]
        if len(others):
            yield loop, loops[random.choice(others)]


def books(loops: Sequence[Loop], follow: Follow) -> Books | None:
    """The work of fingers led round together, by the trapezoidal rule; None where one did not touch
    when it had been pressed in, or touched what it goes along: of what it only grazes there is no
    F d.

    ``follow`` leads ``m`` fingers on along (ticks, m, 3) and gives the forces on them, newton, of
    that shape, and at the end their contact points (m, 3), of tools the middle of the pressure.
    """
    path = np.stack([loop.path for loop in loops], axis=1)
    ends = [0, *(PRESS + REST + number * ROUND for number in range(3)), len(path)]
    parts = [follow(path[begin:end]) for begin, end in pairwise(ends)]
    forces = np.concatenate([part[0] for part in parts])
    places = [part[1] for part in parts]
    size = np.linalg.norm(forces, axis=2)
    depths = np.array([loop.depth for loop in loops])
    pressed = np.linalg.norm(places[0] - path[PRESS + REST - 1], axis=1)
    if size[PRESS + REST - 1].min() == 0.0 or (pressed < GRAZED * depths).any():
        return None
    work = np.einsum("tfx,tfx->t", 0.5 * (forces[1:] + forces[:-1]), np.diff(path, axis=0))
    work /= 0.5 * (size.max(axis=0) * depths).max()
    rounds = []
    for number in range(2):
        begin = PRESS + REST - 1 + number * ROUND
        end = begin + ROUND
        moved = np.linalg.norm(places[number + 1] - places[number], axis=1)
        turned = np.linalg.norm(forces[end] - forces[begin], axis=1)
        is_closed = (moved < SAME * depths).all() and (turned < SAME * size[begin]).all()
        if is_closed and size[begin : end + 1].min() > 0.0:
            rounds.append(float(work[begin:end].sum()))
    return Books(tuple(rounds), float(work.sum()))
