"""How far bodies that nobody holds are from a material's own as one presses deeper.

    python benchmarks/shape/resting_at_depth.py [--laws rubber ...] [--bodies cube ...] [--linear]

Bodies lie on a floor or between tools, without weight. The truth is a contact of the law's solid
with smoothed strains, by Newton's method, that shares nothing with Palpate's
(:mod:`palpate.benchmarks.measuring.shape.pressed.lying_solid`), on the same tetrahedra; a Poisson's
ratio of 0.45, of foam and fibres 0.2. Tools are smooth. Under walls floors are, too, and a body is
pinched without any; under what is round it lies on a rough one (0.5), or in a tray with smooth
walls at its sides. The table is that of ``benchmarks/shape/at_depth.py``; surfaces are compared in
the world, so a body that rolls or slips aside is as far off as it went.

Claimed, where the body comes to rest and the truth is stable: the real force is within 10 %, within
3 % between walls and 5 % under balls; what is drawn is nearer than the linear surface, and in both
within 3 % of the largest displacement. The exit status tells whether that holds.
"""

from __future__ import annotations

import argparse
import sys
from itertools import product

import numpy as np
from scipy.optimize import brentq

from palpate.benchmarks.measuring.shape.pressed.deep_press import LAWS
from palpate.benchmarks.measuring.shape.pressed.resting_bench import RestingBench
from palpate.benchmarks.measuring.shape.pressed.resting_press import BODIES
from palpate.benchmarks.measuring.shape.pressed.rows import Row, head, written
from palpate.core.law.of_material import RUBBER

# Of the cube, metres, and what its truth may be off the force of uniform strain.
EDGE, UNIFORM = 0.05, 0.003


# What is claimed of forces between walls, under balls, elsewhere; of surfaces in the first two.
BETWEEN_WALLS, UNDER_BALLS, ELSEWHERE, DRAWN = 0.03, 0.05, 0.10, 0.03


def holds(row: Row) -> bool:
    """Whether a row is as near as claimed; says where it is not."""
    if not np.isfinite(row.real):
        return True
    is_walled = "wall" in row.name
    is_under_ball = "ball" in row.name
    felt = BETWEEN_WALLS if is_walled else UNDER_BALLS if is_under_ball else ELSEWHERE
    is_felt = abs(row.real - 1.0) <= felt
    linear, real = row.drawn
    is_drawn = real <= (DRAWN if is_walled or is_under_ball else linear)
    if not (is_felt and is_drawn):
        print(f"CLAIM BROKEN: {row.name}, {max(row.depth, row.share):.3g}")
    return is_felt and is_drawn


def agrees(row: Row) -> bool:
    """Whether the cube's force between walls is that of uniform strain; says where it is not."""
    shear = 0.5 / (1.0 + LAWS[RUBBER])
    first = 2.0 * shear * LAWS[RUBBER] / (1.0 - 2.0 * LAWS[RUBBER])
    along = 1.0 - row.share

    def pressure(across: float) -> float:
        return first * (across * across * along - 1.0)

    def stress_aside(across: float) -> float:
        return shear * (across - 1.0 / across) + pressure(across) * across * along

    across = brentq(stress_aside, 1.0, 2.0)
    stress = shear * (along - 1.0 / along) + pressure(across) * across * across
    is_known = abs(row.true / (-1e6 * EDGE * EDGE * stress) - 1.0) <= UNIFORM
    if not is_known:
        print(f"CLAIM BROKEN: {row.name}, {row.share:.3g}: the truth's force is not within 0.3 %")
    return is_known


def main() -> int:
    """Print the tables; 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--laws", nargs="+", choices=list(LAWS), default=[RUBBER])
    parser.add_argument(
        "--bodies", nargs="+", default=list(BODIES), help="of these, or stored ones"
    )
    parser.add_argument("--linear", action="store_true", help="without Real and its claims")
    options = parser.parse_args()
    print(head())
    kept = []
    for law, name in product(options.laws, options.bodies):
        bench = RestingBench.of(name, law, is_linear=options.linear)
        for row in bench.rows():
            print(written(row), flush=True)
            if name == "cube" and law == RUBBER and "wall" in row.name:
                kept.append(agrees(row))
            kept.append(options.linear or not row.is_stable or holds(row))
        bench.close()
    print("the claims hold" if all(kept) else "a claim does NOT hold")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
