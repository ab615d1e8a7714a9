"""How far bends, pulls and twists are from a material's own, as felt and as drawn.

    python benchmarks/shape/strokes_at_depth.py [--laws rubber foam ...] [--bodies cube bar ...]

A hand holds a patch of three edges where the body reaches farthest from its pins, and bends it
aside by three tenths of that reach, in two directions, pulls it by a fifth, and turns it by 45 and
90 degrees, as *Grab*, *Pull* and *Twist* do. The truth is Newton's method by the law's solid
(:mod:`palpate.benchmarks.measuring.shape.pressed.pressed_solid`), with the held nodes where the
linear body has them. For every stroke the table has the force along the way over the linear one,
true and as *Real* tells it, and the largest errors of the drawn surface, linear and *Real*, as
shares of the largest displacement.

Claimed: the force is within 10 %, the drawn surface within 3 %. The exit status tells whether that
holds.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.deep_press import BODIES, LAWS, Bench, farthest_off
from palpate.core.contact.near_field.surface_shape import node_normals
from palpate.core.contact.place import nearest_place
from palpate.core.grip.held_patch import Answer, HeldPatch
from palpate.core.grip.motions import moved, turned
from palpate.core.grip.patch import Grip
from palpate.core.law.of_material import RUBBER
from palpate.core.shape.felt import held_loads
from palpate.core.shape.found_behind import FoundBehind, Shaped

Array = NDArray[np.float64]

RADIUS_EDGES = 3.0
ASIDE, OUT = 0.3, 0.2
# The truth is followed in so many steps.
STEPS = 6
FORCE, DRAWN = 0.10, 0.03


@dataclass(frozen=True)
class Row:
    """A stroke: its force over the linear one, true and told, and the drawn errors."""

    name: str
    true: float
    told: float
    linear: float
    real: float


def strokes(bench: Bench) -> Iterator[tuple[str, HeldPatch, Array]]:
    """All five of a body: what is held, and the shares of the motions."""
    body = bench.body
    nodes, pins = body.mesh.nodes[body.mesh.surface_nodes], body.mesh.nodes[body.fixed]
    away = np.linalg.norm(nodes - pins.mean(axis=0), axis=1)
    place = nearest_place(body, nodes[away.argmax()])
    out = nodes[away.argmax()] - pins.mean(axis=0)
    reach = float(np.linalg.norm(out))
    out /= reach
    first = np.cross(out, np.eye(3)[np.abs(out).argmin()])
    first /= np.linalg.norm(first)
    grip = Grip(place.triangle, place.alpha, out, RADIUS_EDGES * bench.solid.edge)
    held = HeldPatch.of(body, [grip], node_normals(body.mesh))
    yield "bent", held, moved(ASIDE * reach * first)
    yield "bent across", held, moved(ASIDE * reach * np.cross(out, first))
    yield "pulled", held, moved(OUT * reach * out)
    yield "turned by 45", held, turned(np.pi / 4)
    yield "turned by 90", held, turned(np.pi / 2)


def shaped(bench: Bench, answer: Answer) -> Shaped:
    """What *Real* makes of a linear answer."""
    found = FoundBehind(bench.body, bench.shape, 1.0)
    try:
        return found.at_rest(held_loads(bench.body, answer.nodes, answer.forces))
    finally:
        found.close()


def row(bench: Bench, name: str, held: HeldPatch, shares: Array) -> Row:
    """One stroke beside the truth."""
    surface = bench.solid.solid.surface
    answer = held.answer(shares, 1.0)
    told = shaped(bench, answer)
    way = answer.displacements[held.nodes]
    ways = np.linspace(0.0, 1.0, STEPS + 1)[1:, None, None] * way
    *_, true = bench.solid.by_nodes(answer.nodes, ways)
    drawn = true.displacements[surface]
    pushes = true.nodal_forces[np.searchsorted(bench.solid.solid.free, answer.nodes)]
    return Row(
        f"{bench.name}, {name}",
        float((pushes * way).sum() / (answer.forces * way).sum()),
        told.share,
        *(farthest_off(one, drawn) for one in (answer.displacements, told.displacements)),
    )


def holds(found: Row) -> bool:
    """Whether force and surface are as near as promised; says where they are not."""
    if abs(found.told / found.true - 1.0) <= FORCE and found.real <= DRAWN:
        return True
    print(f"CLAIM BROKEN: {found.name}: not within {FORCE:.0%} of the force, {DRAWN:.0%} drawn")
    return False


def main() -> int:
    """Print the table; 1 where the claim does not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--laws", nargs="+", choices=list(LAWS), default=[RUBBER])
    parser.add_argument("--bodies", nargs="+", default=list(BODIES))
    options = parser.parse_args()
    print(f"{'':<32}{'true':>8}{'real':>8}{'off, %':>8}{'drawn: linear':>15}{'real, %':>9}")
    kept = []
    for law, name in product(options.laws, options.bodies):
        bench = Bench.of(name, law)
        for told, held, shares in strokes(bench):
            found = row(bench, told, held, shares)
            print(
                f"{found.name:<32}{found.true:8.3f}{found.told:8.3f}"
                f"{100 * (found.told / found.true - 1):+8.1f}"
                f"{100 * found.linear:15.1f}{100 * found.real:9.1f}",
                flush=True,
            )
            kept.append(holds(found))
        bench.shape.close()
    print("the claim holds" if all(kept) else "the claim does NOT hold")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
