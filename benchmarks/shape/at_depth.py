"""How far the felt force and the drawn shape are from a material's own as one presses deeper.

    python benchmarks/shape/at_depth.py [--laws rubber ...] [--bodies cube ...] [--places N]

The truth is a contact of the law's solid with smoothed strains, by Newton's method
(:mod:`palpate.benchmarks.measuring.shape.pressed.deep_press`), on the same tetrahedra; a Poisson's
ratio of 0.45, of foam and fibres 0.2. For every press the table has

- the force at 1 Pa, mm2, along the press; by how much the linear and the *real* one are off
  (:mod:`palpate.core.shape.felt`);
- the largest error of the drawn surface at rest, as a share of the largest displacement;
- how many places of the surface press, three a triangle.

Claimed: on the cube under a ball of 12 mm rubber's force agrees with another program's; the real
force is within 5 % to half a radius or a fifth of the part's thickness, and within 10 % to a radius
or two fifths; the drawn surface is within 3 % of the largest displacement. Where a tool presses
fewer than 16 places, the truth of these tetrahedra is itself as far from that of finer ones
(``benchmarks/contact/finer_rubber.py``): there the force is within 10 %, and the surface within
30 %. A point that goes in by two fifths crushes what it presses, of which there are several rests:
its force is within 20 %. Where the truth is an equilibrium that is not stable, only the force is
claimed. The exit status tells whether that holds.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from itertools import product

from palpate.benchmarks.measuring.shape.pressed.deep_press import BODIES, LAWS, Bench, rows_of
from palpate.benchmarks.measuring.shape.pressed.rows import Row, head, holds, written
from palpate.core.contact.place import nearest_place
from palpate.core.law.of_material import RUBBER

# A ball of 12 mm on a cube of 50 mm: depth over radius, and rubber's force at 1 Pa by a program of
# others (smoothed tetrahedra of its own), mm2.
CUBE_RADIUS = 0.012
ISSUED = {1 / 12: 5.56, 1 / 3: 43.9, 1 / 2: 78.9, 3 / 4: 140.6, 1.0: 208.4, 4 / 3: 302.7}
# At a twelfth the contact is narrower than a triangle, and the other's triangles are others.
AGREEMENT = 0.11


def issued_rows(bench: Bench) -> Iterator[tuple[Row, float]]:
    """The middle of the cube's top under the ball of 12 mm, with the other program's forces."""
    top = nearest_place(bench.body, [0.025, 0.025, 0.05])
    depths = [CUBE_RADIUS * share for share in ISSUED]
    rows = bench.by_ball(top, CUBE_RADIUS, depths, 0.05, "ball of 12 mm")
    yield from zip(rows, ISSUED.values(), strict=True)


def main() -> int:
    """Print the tables; 1 where a claim does not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--laws", nargs="+", choices=list(LAWS), default=[RUBBER])
    parser.add_argument(
        "--bodies", nargs="+", default=list(BODIES), help="of these, or files of meshes"
    )
    parser.add_argument("--places", type=int, default=2, metavar="N", help="places of each body")
    options = parser.parse_args()
    print(head())
    kept = []
    for law, name in product(options.laws, options.bodies):
        bench = Bench.of(name, law)
        if (name, law) == ("cube", RUBBER):
            for row, issued in issued_rows(bench):
                print(f"{written(row)}   the other program {issued:.1f}", flush=True)
                kept += [abs(row.true / issued - 1.0) <= AGREEMENT, holds(row)]
        for row in rows_of(bench, options.places):
            print(written(row), flush=True)
            kept.append(holds(row))
        bench.shape.close()
    print("the claims hold" if all(kept) else "a claim does NOT hold")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
