"""Bodies under named loads that deform them far: five presses, three bends, and on large bodies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.tests.bodies.baked_body import baked_body

from ..bodies import tets_of
from ..refined import refined
from .solved_body import SolvedBody

CUBE_EDGE = 0.05
BEAM_LENGTH, BEAM_WIDTH, BEAM_CELLS = 0.12, 0.02, 6
LARGE_BEAM_CELLS = 22


@dataclass(frozen=True, eq=False)
class Load:
    """Forces on surface nodes of a body.

    Attributes
    ----------
    name : how tables call it.
    kind : ``press`` or ``bend``.
    body : what is loaded.
    nodes, nodal_forces : (k,), (k, 3) newton at the body's own modulus.
    """

    name: str
    kind: str
    body: SoftBody
    nodes: NDArray[np.int64]
    nodal_forces: NDArray[np.float64]


def loads() -> list[Load]:
    """All eight."""
    cube, mouse, hare, beam = cube_body(), mouse_body(), hare_body(), beam_body()
    top = CUBE_EDGE * np.array([0.5, 0.5, 1.0])
    tip = highest(hare)
    return [
        pushed("cube, middle of the top", "press", cube, top, 0.014, [0, 0, -1], 0.005),
        pushed("cube, edge", "press", cube, [0.0, 0.025, 0.05], 0.014, [1, 0, -1], 0.003),
        pushed("mouse, back", "press", mouse, highest(mouse), 0.015, [0, 0, -1], 0.005),
        pushed("mouse, nose", "press", mouse, farthest(mouse, 0), 0.012, [-1, 0, 0], 0.004),
        pushed("hare, belly", "press", hare, [0.05, 0.0, 0.035], 0.015, [-1, 0, 0], 0.004),
        pushed("beam, bent at its end", "bend", beam, [BEAM_LENGTH, 0, 0], 0.03, [0, 0, 1], 0.06),
        twisted("beam, twisted", beam, 1.2),
        pushed("hare, ear bent aside", "bend", hare, tip, 0.012, [0, -np.sign(tip[1]), 0], 0.06),
    ]


def large_loads() -> Iterator[Load]:
    """Two presses and two bends of bodies of 12 to 20 thousand nodes."""
    hare = large_hare()
    tip = highest(hare)
    yield pushed("large hare, ear", "bend", hare, tip, 0.012, [0, -np.sign(tip[1]), 0], 0.06)
    yield pushed("large hare, belly", "press", hare, [0.05, 0, 0.035], 0.015, [-1, 0, 0], 0.004)
    mouse = large_mouse()
    yield pushed("mouse-20k, back", "press", mouse, highest(mouse), 0.015, [0, 0, -1], 0.005)
    beam = large_beam()
    end = [BEAM_LENGTH, 0, 0]
    yield pushed("large beam, bent", "bend", beam, end, 0.03, [0, 0, 1], 0.06)


def pushed(
    name: str,
    kind: str,
    body: SoftBody,
    place: ArrayLike,
    radius: float,
    direction: ArrayLike,
    by: float,
) -> Load:
    """Free surface nodes within ``radius`` of the surface's nearest place share a force equally.

    It moves them by ``by`` metres along its direction, on average, where a body stays linear.
    """
    free = body.compliance.free_surface
    found = body.closest_points.query(np.asarray(place, dtype=np.float64))
    corners = body.mesh.nodes[body.mesh.surface_triangles[found.triangle[0]]]
    nearest = found.alpha[0] @ corners
    nodes = free[np.linalg.norm(body.mesh.nodes[free] - nearest, axis=1) < radius]
    way = np.asarray(direction, dtype=np.float64)
    forces = np.tile(way / np.linalg.norm(way), (len(nodes), 1))
    return _scaled(name, kind, body, nodes, forces, by)


def twisted(name: str, body: SoftBody, angle: float) -> Load:
    """Forces around the x axis at the free end, which turn it by ``angle`` where it stays linear.

    They keep their directions, so that the true angle is smaller.
    """
    free = body.compliance.free_surface
    nodes = free[body.mesh.nodes[free, 0] == body.mesh.nodes[:, 0].max()]
    arms = body.mesh.nodes[nodes] - [BEAM_LENGTH, 0.0, 0.0]
    forces = np.cross([1.0, 0.0, 0.0], arms)
    return _scaled(
        name, "bend", body, nodes, forces, angle * float(np.linalg.norm(arms, axis=1).mean())
    )


def _scaled(
    name: str,
    kind: str,
    body: SoftBody,
    nodes: NDArray[np.int64],
    forces: NDArray[np.float64],
    by: float,
) -> Load:
    moved = body.deform(nodes, forces)[body.free_index(nodes)]
    along = np.einsum("ki,ki->k", moved, forces) / np.linalg.norm(forces, axis=1).clip(1e-300)
    return Load(name, kind, body, nodes, forces * by / float(along[forces.any(axis=1)].mean()))


def highest(body: SoftBody) -> NDArray[np.float64]:
    """The highest place of a body, (3,)."""
    return farthest(body, 2)


def farthest(body: SoftBody, axis: int) -> NDArray[np.float64]:
    """The place farthest along an axis, (3,)."""
    place: NDArray[np.float64] = body.mesh.nodes[body.mesh.nodes[:, axis].argmax()]
    return place


@cache
def cube_body() -> SoftBody:
    """The paper's cube of a material that hardly changes its volume, with smoothed strains."""
    mesh, fixed = paper_cube(CUBE_EDGE)
    return baked_body(mesh, fixed, 0.49, 10_000.0, "smoothed")


@cache
def beam_body() -> SoftBody:
    """A beam along x with a square section, clamped at x = 0."""
    return baked_body(*_beam_tets(BEAM_CELLS), 0.3, 10_000.0)


def _beam_tets(cells: int) -> tuple[TetMesh, NDArray[np.int64]]:
    mesh, _ = paper_cube(1.0, cells)
    nodes = mesh.nodes * [BEAM_LENGTH, BEAM_WIDTH, BEAM_WIDTH]
    nodes[:, 1:] -= BEAM_WIDTH / 2
    return TetMesh.checked(nodes, mesh.tets), np.flatnonzero(nodes[:, 0] == 0.0)


@cache
def mouse_body() -> SoftBody:
    """The plush mouse of 1.7k nodes."""
    return baked_body(*tets_of("mouse-1.7k"), 0.3, 1000.0)


@cache
def hare_body() -> SoftBody:
    """The plush hare with long ears, from the sample scenes."""
    return baked_body(*tets_of("hare"), 0.3, 1000.0)


def large_hare() -> SolvedBody:
    """The hare with every tetrahedron cut in eight, 12,000 nodes."""
    return SolvedBody.of(*refined(*tets_of("hare")), 0.3, 1000.0)


def large_mouse() -> SolvedBody:
    """The plush mouse of 20,000 nodes."""
    return SolvedBody.of(*tets_of("mouse-20k"), 0.3, 1000.0)


def large_beam() -> SolvedBody:
    """The beam of :func:`beam_body` with 12,000 nodes."""
    return SolvedBody.of(*_beam_tets(LARGE_BEAM_CELLS), 0.3, 10_000.0)
