"""The tables of (16): what they cost and how near they are, on the paper's cube and on the mouse.

    python benchmarks/shape/paper_tables.py [--body cube|mouse] [--sample N] [--picture PATH]

Of some freedoms, both signs, entries as they are filled (power series, checked by Newton's method)
beside those that Newton's method finds alone, in load steps from rest, halving F0 until the solid
carries it: processor time, F0, and the difference where F0 is the same. For the cube (50 mm, 10
kPa, Poisson's ratio 0.49, F0 of 2 N) also the whole table: how many freedoms carry 2 N, which F0
the others got, and what the three tables take; with ``--picture`` the comparison of the paper's
Figure 4. Claimed: entries differ by at most a thousandth of the surface's displacement; four in
five F0 are as large as Newton's method alone finds them; and they cost an eighth of it or less.
The exit status tells whether that holds. Some minutes for the mouse.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from palpate.benchmarks.measuring.bodies import tets_of
from palpate.benchmarks.measuring.shape.figure_4 import draw_figure_4
from palpate.core.body.soft_body import SoftBody
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.shape.paper.paper_entries import SIGNS, EntryFinder, usual_largest_force
from palpate.core.shape.paper.paper_table import PaperTable
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.tests.bodies.baked_body import baked_body
from palpate.tests.referees.newton_entries import largest_carried

YOUNG_MODULUS = 10_000.0
LARGEST_DIFFERENCE, LEAST_AS_LARGE, LEAST_CHEAPER = 1e-3, 0.8, 8.0


def main() -> int:
    """Print the report; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--body", choices=("cube", "mouse"), action="append")
    parser.add_argument("--sample", type=int, default=30, metavar="N")
    parser.add_argument("--picture", type=Path, help="also draw Figure 4 here")
    options = parser.parse_args()
    held = True
    for name in options.body or ("cube", "mouse"):
        made = body(name)
        held &= compared(name, made, options.sample)
        if name == "cube":
            table = whole(made)
            if options.picture is not None:
                draw_figure_4(options.picture, table)
    print("the claims hold" if held else "A CLAIM DOES NOT HOLD")
    return 0 if held else 1


def body(name: str) -> SoftBody:
    """The cube or the stored mouse."""
    stored, poisson_ratio = {"cube": ("cube", 0.49), "mouse": ("mouse-1.7k", 0.3)}[name]
    return baked_body(*tets_of(stored), poisson_ratio, YOUNG_MODULUS)


def compared(name: str, made: SoftBody, sample: int) -> bool:
    """Entries of random freedoms beside those of Newton's method alone."""
    solid, wanted = FreeSolid.of(made, StVenantKirchhoff()), usual_largest_force(made.mesh)
    finder = EntryFinder(solid)
    _ = finder.at_rest
    every = 3 * made.compliance.node_count
    freedoms = np.random.default_rng(1999).choice(every, sample, replace=False).tolist()
    began = time.process_time()
    found = [finder.entries(freedom, wanted) for freedom in freedoms]
    filled = time.process_time()
    alone = [
        [largest_carried(solid, freedom, sign * wanted) for sign in SIGNS] for freedom in freedoms
    ]
    seconds = filled - began, time.process_time() - filled
    carried = np.array([[abs(load) for load, _ in two] for two in alone])
    halvings = np.rint(np.log2(carried / [one.largest for one in found])).astype(int)
    errors = []
    for one, two, more in zip(found, alone, halvings, strict=True):
        for at in np.flatnonzero(more == 0):
            load, end = two[at]
            true = end.displacements[solid.surface].ravel() / load
            errors.append(np.linalg.norm(one.per_force[at] - true) / np.linalg.norm(true))
    by_series = np.array([one.by_series for one in found])
    cheaper, as_large = seconds[1] / seconds[0], float((halvings <= 0).mean())
    held = max(errors) <= LARGEST_DIFFERENCE
    held &= as_large >= LEAST_AS_LARGE and cheaper >= LEAST_CHEAPER
    each = [1e3 * one / halvings.size for one in seconds]
    print(
        f"{name}, {halvings.size} of {2 * every} entries: {each[0]:.1f} ms each, by Newton's "
        f"method alone {each[1]:.0f} ms, {cheaper:.0f} times as much; the whole table "
        f"{2e-3 * every * each[0]:.0f} s instead of {2e-3 * every * each[1]:.0f} s\n"
        f"  the series' own {by_series.mean():.0%}, ended by Newton's method the rest; F0 as large "
        f"{as_large:.0%}, halved so often more {np.unique(halvings, return_counts=True)}\n"
        f"  difference where F0 is the same: median {np.median(errors):.1e}, largest "
        f"{max(errors):.1e}" + ("" if held else "  NOT HELD"),
        flush=True,
    )
    return bool(held)


def whole(made: SoftBody) -> PaperTable:
    """The table of all freedoms: which F0 they have, by the direction of the force; its cost."""
    table = PaperTable(made)
    began = time.process_time()
    table.fill(np.arange(made.compliance.node_count))
    print(
        f"whole table in {time.process_time() - began:.1f} s; "
        f"L {made.compliance.nbytes / 1e3:.0f} kB, with L+ and L- "
        f"{(made.compliance.nbytes + table.nbytes - table.largest.nbytes) / 1e3:.0f} kB"
    )
    newton = YOUNG_MODULUS * table.largest
    places = made.mesh.nodes[made.compliance.free_surface]
    middle = 0.5 * (made.mesh.nodes.min(axis=0) + made.mesh.nodes.max(axis=0))
    outside = np.abs(np.abs(places - middle) - middle) < 1e-9
    # A force is outward or inward along an axis whose face the node is on, else along the surface.
    outward = outside & (places > middle)
    pulls = np.stack([outward, outside & ~outward], axis=2)
    pushes = np.stack([outside & ~outward, outward], axis=2)
    print(f"{'F0':>8s}{'all':>8s}{'pull':>8s}{'push':>8s}{'along':>8s}")
    for force in [*np.unique(newton)[::-1], None]:
        here = np.full(newton.shape, fill_value=True) if force is None else newton == force
        counts = [here, here & pulls, here & pushes, here & ~pulls & ~pushes]
        name = "of" if force is None else f"{force:.3f} N"
        print(f"{name:>8s}" + "".join(f"{int(count.sum()):8d}" for count in counts))
    return table


if __name__ == "__main__":
    sys.exit(main())
