"""Energy that points give on random closed paths without friction; none may.

    python benchmarks/contact/energy_loops.py [--loops N] [--seed S] [--body NAME] [--feel NAME]

Fingers come from the air, go in along a normal, twice round an ellipse in any plane, and out as
they came: over facets, edges, corners and thin parts of the sample bodies, 0.1 to 4 edges of the
mesh deep and wide, in steps of less than a hundredth of the depth, by the servo's own ticks. Work
is that of the forces as sent, by the trapezoidal rule, of all fingers, as a share of F d / 2
(largest force, depth of the press). Columns: rounds that touched throughout and ended where they
began, the share of them that gave more than 0.1 and 1 %, the most that one gave, and the mean loss
of the others; the same of whole paths, from air to air. *Motors* have the coupling of a device,
*cut off* a force limit of 0.6 of what is asked, *two* are points beside each other, led together.
``paper`` is as published, without a claim. Exit status 1 where another one gave more than 0.1 %.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedFingers

from palpate.benchmarks.contact.continuity import BODIES, YOUNG_MODULUS, soft_body
from palpate.core.body.soft_body import SoftBody
from palpate.core.servo.session import native_body
from palpate.core.servo.settings import Coupling, Settings
from palpate.tests.referees.energy_loops import (
    Books,
    Follow,
    Loop,
    books,
    random_loops,
    random_pairs,
)

Vectors = NDArray[np.float64]
MOST = 1e-3
CUT_OFF = 0.6


@dataclass(frozen=True)
class Way:
    """A way to be felt, and how many points there are.

    Attributes
    ----------
    motors : newton, what they bear; None without motors.
    is_cut_off : whether the force limit is `CUT_OFF` of the most that is asked for.
    """

    settings: Settings = field(default_factory=lambda: Settings(YOUNG_MODULUS))
    fingers: int = 1
    motors: float | None = None
    is_cut_off: bool = False


COUPLED = Settings(YOUNG_MODULUS, coupling=Coupling(800.0, 4.0, passivity_control=True))
WAYS = {
    "paper": Way(Settings(YOUNG_MODULUS, mode="paper")),
    "consistent": Way(),
    "shaded": Way(Settings(YOUNG_MODULUS, shading=True)),
    "motors": Way(COUPLED, motors=3.0),
    "cut off": Way(is_cut_off=True),
    "two": Way(fingers=2),
    "two, motors": Way(COUPLED, fingers=2, motors=3.0),
}


def by(native: Body, way: Way, starts: Vectors, motors: float | None) -> Follow:
    """Points of the servo, set down at ``starts`` (m, 3)."""
    fingers = SteppedFingers(native, starts, way.settings, max_force=motors)

    def follow(path: Vectors) -> tuple[Vectors, Vectors]:
        forces = np.asarray(fingers.sent(path))
        return forces, np.array([shot.proxy for shot in fingers.snapshot().fingers])

    return follow


def books_of(native: Body, way: Way, loops: Sequence[Loop]) -> Books | None:
    """The books of fingers that are led together."""
    path = np.stack([loop.path for loop in loops], axis=1)
    motors = way.motors
    if way.is_cut_off:
        asked, _ = by(native, way, path[0], None)(path)
        motors = CUT_OFF * float(np.linalg.norm(asked, axis=2).max()) or None
    return books(loops, by(native, way, path[0], motors))


def of_body(body: SoftBody, way: Way, count: int, seed: int) -> list[Books]:
    """The books of random loops."""
    native = native_body(body, whole=way.fingers > 1)
    mesh = body.mesh
    free = ~np.isin(mesh.surface_nodes, body.fixed)
    nodes = mesh.nodes[mesh.surface_nodes]
    loops = list(random_loops(nodes, mesh.surface_local_triangles, free, count, seed))
    led: Iterator[Sequence[Loop]] = iter([(loop,) for loop in loops])
    if way.fingers > 1:
        led = islice(random_pairs(loops, seed), count)
    found = (books_of(native, way, together) for together in led)
    return [one for one in found if one is not None]


def row(name: str, feel: str, found: list[Books]) -> bool:
    """Prints a row; whether no more came out than claimed."""
    rounds = np.array([gain for one in found for gain in one.rounds])
    paths = np.array([one.path for one in found])
    print(
        f"{name:<10} {feel:<12} {len(found):6} {len(rounds):7} {(rounds > MOST).mean():8.2%} "
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
    arguments.add_argument("--feel", choices=WAYS)
    chosen = arguments.parse_args()
    print("body       felt          loops  rounds   > 0.1 %    > 1 %  most out     loss")
    print(f"{'':75}   > 0.1 %  most out     loss (from air to air)")
    holds = True
    for name in [chosen.body] if chosen.body else BODIES:
        body = soft_body(name)
        for feel in [chosen.feel] if chosen.feel else WAYS:
            holds &= row(name, feel, of_body(body, WAYS[feel], chosen.loops, chosen.seed))
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
