"""The paper's tables for its cube: F0 of 2 N on every freedom, and what becomes of Figure 4.

    python benchmarks/shape/paper_tables.py [--sample N] [--picture docs/images/figure-4.png]

All 73 free surface nodes of the cube (50 mm, 10 kPa, Poisson's ratio 0.49), three axes, two signs.
It prints how many freedoms carry 2 N, which F0 the others got, and what the three tables take; with
``--picture`` it also draws the comparison of the paper's Figure 4. Claimed: entries equal
equilibria that are solved anew, in small load steps, to 1e-6 of the largest displacement, on a
sample of freedoms; and F0 is halved for no freedom that carries more. The exit status tells whether
that holds. A busy machine changes nothing but the time it takes, a minute or two.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from palpate.benchmarks.measuring.shape.figure_4 import draw_figure_4
from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper.newton_shape import NewtonTable
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import NoEquilibrium, equilibrium
from palpate.core.stiffness.assembly import assemble

YOUNG_MODULUS, POISSON_RATIO = 10_000.0, 0.49
LARGEST_FORCE = 2.0
LARGEST_DIFFERENCE = 1e-6
SMALL_STEP = 1 / 16


def main() -> int:
    """Print the report; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--sample", type=int, default=30, metavar="N")
    parser.add_argument("--picture", type=Path, help="also draw Figure 4 here")
    options = parser.parse_args()
    mesh, fixed = paper_cube()
    compliance = surface_compliance(mesh, assemble(mesh, POISSON_RATIO), fixed)
    body = SoftBody(mesh, fixed, POISSON_RATIO, compliance, YOUNG_MODULUS)
    table = NewtonTable(body, LARGEST_FORCE / YOUNG_MODULUS)
    began = time.perf_counter()
    table.fill(np.arange(compliance.node_count))
    seconds = time.perf_counter() - began
    report(table)
    print(
        f"solved in {seconds:.0f} s, {1e3 * seconds / table.largest.size:.0f} ms an entry\n"
        f"L {compliance.nbytes / 1e3:.0f} kB, with L+ and L- "
        f"{(compliance.nbytes + table.nbytes - table.largest.nbytes) / 1e3:.0f} kB"
    )
    held = checked(table, FreeSolid.of(body), options.sample)
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    if options.picture is not None:
        draw_figure_4(options.picture, table)
    return 0 if held else 1


def report(table: NewtonTable) -> None:
    """How many freedoms and signs have which F0, in all and by the direction of the force."""
    body = table.body
    newton = YOUNG_MODULUS * table.largest
    places = body.mesh.nodes[body.compliance.free_surface]
    middle = 0.5 * (body.mesh.nodes.min(axis=0) + body.mesh.nodes.max(axis=0))
    outside = np.abs(np.abs(places - middle) - middle) < 1e-9
    # A force is outward or inward along an axis whose face the node is on, else along the surface.
    outward = outside & (places > middle)
    pulls = np.stack([outward, outside & ~outward], axis=2)
    pushes = np.stack([outside & ~outward, outward], axis=2)
    print(f"{'F0':>8s}{'all':>8s}{'pull':>8s}{'push':>8s}{'along':>8s}")
    for force in np.unique(newton)[::-1]:
        here = newton == force
        counts = [chosen.sum() for chosen in (here, here & pulls, here & pushes)]
        counts.append((here & ~pulls & ~pushes).sum())
        print(f"{force:6.3f} N" + "".join(f"{int(count):8d}" for count in counts))
    print(
        f"{'of':>8s}"
        + "".join(
            f"{int(n):8d}"
            for n in (newton.size, pulls.sum(), pushes.sum(), (~pulls & ~pushes).sum())
        )
    )


def checked(table: NewtonTable, solid: FreeSolid, sample: int) -> bool:
    """Whether entries of some freedoms are right, and no F0 was halved without need."""
    chosen = np.random.default_rng(1999).permutation(table.largest.size)[:sample]
    worst, too_small = 0.0, 0
    for node, axis, sign in zip(*np.unravel_index(chosen, table.largest.shape), strict=True):
        load = table.largest[node, axis, sign] * (1 - 2 * sign)
        unit = np.zeros((solid.node_count, 3))
        unit[solid.surface[node], axis] = 1.0
        found = equilibrium(solid, load * unit, largest_step=SMALL_STEP).displacements
        entries = (table.negative if sign else table.positive)[int(node)][axis]
        expected = found[solid.surface].ravel() / load
        worst = max(worst, float(np.abs(entries - expected).max() / np.abs(expected).max()))
        if abs(load) < 0.99 * table.wanted:
            too_small += carries(solid, 2.0 * load * unit)
    print(
        f"{len(chosen)} entries differ from equilibria in small load steps by {worst:.1e} at most"
    )
    print(f"{too_small} of them would carry twice their F0")
    return worst <= LARGEST_DIFFERENCE and not too_small


def carries(solid: FreeSolid, forces: np.ndarray) -> bool:
    """Whether small load steps lead to an equilibrium."""
    try:
        equilibrium(solid, forces, largest_step=SMALL_STEP)
    except NoEquilibrium:
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
