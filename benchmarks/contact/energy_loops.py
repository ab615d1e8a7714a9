"""Energy that a point gives on random closed paths without friction; none may.

    python benchmarks/contact/energy_loops.py [--loops N] [--seed S] [--body NAME]

A finger comes from the air, goes in along a normal, twice round an ellipse in any plane, and out
as it came: over facets, edges, corners and thin parts of the sample bodies, 0.1 to 4 edges of the
mesh deep and wide, in steps of less than a hundredth of the depth, by the servo's own ticks. Work
is that of the contact force by the trapezoidal rule, as a share of F d / 2 (largest force, depth of
the press). Columns: rounds that touched throughout and ended where they began, the share of them
that gave more than 0.1 and 1 %, the most that one gave, and the mean loss of the others; the same
of whole paths, from air to air. ``paper`` is as published, without a claim. Exit status 1 where
another mode gave more than 0.1 %.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedFingers

from palpate.benchmarks.contact.continuity import BODIES, YOUNG_MODULUS, soft_body
from palpate.core.body.soft_body import SoftBody
from palpate.core.servo.session import native_body
from palpate.core.servo.settings import Settings
from palpate.tests.referees.energy_loops import Books, Follow, books, random_loops

Vectors = NDArray[np.float64]
MOST = 1e-3
FEELS = {
    "paper": Settings(YOUNG_MODULUS, mode="paper"),
    "consistent": Settings(YOUNG_MODULUS),
    "shaded": Settings(YOUNG_MODULUS, shading=True),
}


def by(native: Body, settings: Settings, start: Vectors) -> Follow:
    """One point of the servo, set down at ``start`` (3,)."""
    fingers = SteppedFingers(native, start[None], settings)

    def follow(path: Vectors) -> tuple[Vectors, Vectors]:
        forces = np.asarray(fingers.follow(path[:, None])[0][:, 0])
        return forces, np.asarray(fingers.snapshot().fingers[0].proxy)

    return follow


def of_body(body: SoftBody, settings: Settings, count: int, seed: int) -> list[Books]:
    """The books of random loops."""
    native = native_body(body)
    mesh = body.mesh
    free = ~np.isin(mesh.surface_nodes, body.fixed)
    nodes = mesh.nodes[mesh.surface_nodes]
    loops = random_loops(nodes, mesh.surface_local_triangles, free, count, seed)
    found = (books(loop, by(native, settings, loop.press[0])) for loop in loops)
    return [one for one in found if one is not None]


def row(name: str, feel: str, found: list[Books]) -> bool:
    """Prints a row; whether no more came out than claimed."""
    rounds = np.array([gain for one in found for gain in one.rounds])
    paths = np.array([one.path for one in found])
    print(
        f"{name:<10} {feel:<11} {len(found):6} {len(rounds):7} {(rounds > MOST).mean():8.2%} "
        f"{(rounds > 0.01).mean():8.2%} {rounds.max():9.3%} {-rounds[rounds < 0].mean():8.1%}   "
        f"{(paths > MOST).mean():8.2%} {paths.max():9.3%} {-paths[paths < 0].mean():8.1%}",
        flush=True,
    )
    return feel == "paper" or max(rounds.max(), paths.max()) <= MOST


def main() -> int:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    arguments.add_argument("--loops", type=int, default=2500, help="of each body and mode")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--body", choices=BODIES)
    chosen = arguments.parse_args()
    print("body       mode         loops  rounds   > 0.1 %    > 1 %  most out     loss")
    print(f"{'':74}   > 0.1 %  most out     loss (from air to air)")
    holds = True
    for name in [chosen.body] if chosen.body else BODIES:
        body = soft_body(name)
        for feel, settings in FEELS.items():
            holds &= row(name, feel, of_body(body, settings, chosen.loops, chosen.seed))
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
