"""How far the felt force and the drawn shape are from a material's own as one presses deeper.

    python benchmarks/shape/laws_at_depth.py [--laws foam fibres natural-rubber] [--bodies cube bar]

As :mod:`.at_depth`, which has rubber's: the truth is Newton's method with a contact of its own, by
the law, on the same tetrahedra of smoothed strains; a Poisson's ratio of 0.2 for foam and fibres.

Claimed: the felt force is within 20 %, but for the presses in :data:`BEYOND`. The exit status tells
whether it holds.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace

import numpy as np

from palpate.benchmarks.measuring.shape.pressed_rubber import PressedRubber
from palpate.benchmarks.shape.at_depth import Bench, Row, body_of, rows_of, written
from palpate.core.shape.shapes import shape
from palpate.tests.bodies.baked_body import baked_body

LAWS = {"foam": 0.2, "fibres": 0.2, "natural-rubber": 0.45}
BODIES = ("cube", "bar")
MOST = 0.20
BEYOND: tuple[str, ...] = ()


def bench_of(name: str, law: str) -> Bench:
    """A body of a law, ready to be pressed."""
    made = body_of(name)
    baked = baked_body(made.mesh, made.fixed, LAWS[law], 1.0, "smoothed")
    body = replace(baked, law=law)
    real = shape(body, "real")
    real.wait_for(body.mesh.surface_nodes[:1])
    return Bench(f"{name}, {law}", body, PressedRubber(body), real)


def holds(row: Row) -> bool:
    """Whether the felt force is as near as promised; says where it is not."""
    if f"{row.name}, {row.depth:.3g}" in BEYOND or abs(row.real - 1.0) <= MOST:
        return True
    print(f"CLAIM BROKEN: {row.name}, {row.depth:.3g}: the felt force is not within {MOST:.0%}")
    return False


def main() -> int:
    """Print the tables; 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--laws", nargs="+", choices=list(LAWS), default=list(LAWS))
    parser.add_argument("--bodies", nargs="+", choices=BODIES, default=list(BODIES))
    options = parser.parse_args()
    heads = ["linear", "felt", "drawn", "felt"]
    print(f"{'':<26}{'depth':>7}{'share':>7}{'truth':>10}" + "".join(f"{h:>9}" for h in heads))
    kept = []
    for law in options.laws:
        for name in options.bodies:
            bench = bench_of(name, law)
            rows = list(rows_of(bench, 2))
            if name == "cube":
                rows += bench.by_wall(np.array([0.0, 0.0, 1.0]))
            for row in rows:
                print(written(row), flush=True)
                kept.append(holds(row))
            bench.shape.close()
    print("the claims hold" if all(kept) else "a claim does NOT hold")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
