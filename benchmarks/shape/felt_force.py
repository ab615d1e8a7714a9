"""The felt force at large depth: linear and corrected beside the solid itself.

    python benchmarks/shape/felt_force.py [--places N] [--bodies cube mouse-1.7k]

At places drawn at random, one half nodes and the other inside triangles, a point is pressed
straight in, and 30 degrees aslant, from 2 to 30 % of the thickness there. The force is that of the
linear relation, of the corrected one, and of St. Venant-Kirchhoff's solid with the point held
exactly there (Newton's method). A row is a depth; shown are medians of |difference| / |force of the
solid| over the places at which all elements are still upright (least det F > 0), and how many these
are. Where elements have turned inside out the solid is no referee. The cube is followed so far, the
mouse until it gives way.

Claimed:

* upright: in 90 % of all presses the corrected force is nearer to the solid's than the linear one;
  its median error is less than a third of the linear one's up to a fifth of the thickness, and less
  than two thirds beyond;
* everywhere: it grows with the depth and is at most the linear one.

The exit status tells whether that holds. Takes a minute; a busy machine changes nothing else.
"""

from __future__ import annotations

import argparse
import sys
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.place import Place, nearest_place
from palpate.core.contact.single_press import touch_at
from palpate.core.shape.force_at_depth.softening_table import SofteningTable
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.softness.parallel_rays import thickness
from palpate.core.stiffness.pins import PinNodes
from palpate.tests.referees.pressed_point import pressed_point

BODIES = ("cube", "mouse-1.7k")
SHARES = np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3])
SLANT = np.radians(30.0)
LEAST_NEARER = 0.9
SHALLOW = 0.2
LARGEST_MEDIAN_SHARES = (1.0 / 3.0, 2.0 / 3.0)


class Row(NamedTuple):
    """One press at one depth; errors relative to the solid's force."""

    share: float
    linear: float
    corrected: float


def main() -> int:
    """Print the table; the exit status tells whether the claims hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=BODIES, choices=BODIES)
    parser.add_argument("--places", type=int, default=16, metavar="N", help="default %(default)d")
    options = parser.parse_args()
    held = True
    for name in options.bodies:
        rows: list[Row] = []
        grows = True
        body = _body(name)
        solid, table = FreeSolid.of(body), SofteningTable(body)
        places = _places(body, options.places)
        table.wait_for(body.mesh.surface_triangles[[place.triangle for place in places]])
        table.close()
        for number, place in enumerate(places):
            direction = place.axis if number % 4 < 2 else _aslant(place.axis)
            found, is_sane = _pressed(body, solid, table.values, place, direction)
            rows += found
            grows &= is_sane
        held &= _report(name, rows) and grows
        print(f"{name}: {'grows everywhere, never above linear' if grows else 'DOES NOT GROW'}")
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


def _body(name: str) -> SoftBody:
    mesh, fixed = tets_of(name)
    return bake(mesh, BakeSettings(0.3, 1.0, PinNodes(fixed)))[0]


def _places(body: SoftBody, count: int) -> list[Place]:
    """Nodes and insides of free triangles, by turns."""
    rng = np.random.default_rng(1999)
    free = np.flatnonzero(~np.isin(body.mesh.surface_triangles, body.fixed).any(axis=1))
    found = []
    for number, triangle in enumerate(rng.choice(free, count, replace=False)):
        alpha = np.eye(3)[0] if number % 2 else rng.dirichlet([2, 2, 2])
        corners = body.mesh.nodes[body.mesh.surface_triangles[triangle]]
        axis = nearest_place(body, alpha @ corners).axis
        found.append(Place(alpha @ corners, axis, int(triangle), alpha))
    return found


def _aslant(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    across /= np.linalg.norm(across)
    slanted: NDArray[np.float64] = np.cos(SLANT) * axis + np.sin(SLANT) * across
    return slanted


def _pressed(
    body: SoftBody,
    solid: FreeSolid,
    softenings: NDArray[np.float64],
    place: Place,
    direction: NDArray[np.float64],
) -> tuple[list[Row], bool]:
    displacements = SHARES[:, None] * thickness(body, place) * direction
    linear, corrected = (
        np.array(
            [
                -touch_at(body, place.triangle, place.alpha, u, softenings=table).force
                for u in displacements
            ]
        )
        for table in (None, softenings)
    )
    work, most = corrected @ direction, linear @ direction
    is_sane = bool((np.diff(work) > 0).all() and (work > 0).all() and (work <= most).all())
    corners = body.mesh.surface_triangles[place.triangle]
    true = pressed_point(solid, corners, place.alpha, displacements)
    rows = []
    for k, force in enumerate(true.forces):
        missed = [np.linalg.norm(other[k] - force) for other in (linear, corrected)]
        size = np.linalg.norm(force)
        rows.append(Row(float(SHARES[k]), float(missed[0] / size), float(missed[1] / size)))
    return rows, is_sane


def _report(name: str, rows: list[Row]) -> bool:
    print(f"{name:12s}{'depth':>8s}{'upright':>9s}{'linear':>10s}{'corrected':>11s}{'worst':>9s}")
    is_small = True
    for share in SHARES:
        here = [row for row in rows if row.share == share]
        if not here:
            continue
        linear, corrected = (
            np.array([getattr(row, kind) for row in here]) for kind in ("linear", "corrected")
        )
        medians = float(np.median(linear)), float(np.median(corrected))
        is_small &= medians[1] < LARGEST_MEDIAN_SHARES[int(share > SHALLOW)] * medians[0]
        print(
            f"{'':12s}{share:8.0%}{len(here):9d}{medians[0]:10.1%}{medians[1]:11.2%}"
            f"{corrected.max():9.1%}"
        )
    nearer = np.mean([row.corrected < row.linear for row in rows])
    print(f"{name}: nearer than linear in {nearer:.0%} of {len(rows)} presses")
    return is_small and bool(nearer >= LEAST_NEARER)


if __name__ == "__main__":
    sys.exit(main())
