"""A fingertip pressed on a cube, beside another finite element method.

    python benchmarks/contact_referee.py [--cells N ...]

The referee is scikit-fem with quadratic elements and its own contact; see
``measuring/contact_reference.py``. A sphere of 14 mm is pressed on the cube of 50 mm, by Palpate on
8 and 12 cells with contact points 1.5 mm apart, and as users have it, with the sphere's own points.
Claimed: within 3 % in small strain, up to a tenth of the radius, with the fine points, 3.5 % with
the sphere's own. The exit status tells whether that holds. A busy machine changes nothing but the
time it takes.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from measuring.contact_reference import reference_forces

from palpate.core.contact_points import contact_points
from palpate.core.near_field import near_correction
from palpate.core.paper_cube import paper_cube
from palpate.core.soft_body import SoftBody
from palpate.core.stiffness import assemble
from palpate.core.surface_compliance import surface_compliance
from palpate.core.tool_contact import press_tool
from palpate.core.tools import Pose, sphere

EDGE, RADIUS = 0.05, 0.014
YOUNG_MODULUS, POISSON_RATIO = 10_000.0, 0.3
DEPTHS = (0.0007, 0.0014, 0.002)
LARGEST_CLAIMED_DEPTH = 0.1 * RADIUS
LARGEST_ERROR, LARGEST_ERROR_OWN = 0.03, 0.035
FINE_SPACING = 0.0015


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cells", type=int, nargs="+", default=(4, 6, 8), metavar="N")
    held = True
    print("depth / radius   " + "   ".join(f"{depth / RADIUS:7.3f}" for depth in DEPTHS))
    expected: list[float] = []
    for cells in parser.parse_args().cells:
        expected = reference_forces(EDGE, RADIUS, DEPTHS, YOUNG_MODULUS, POISSON_RATIO, cells)
        print(
            f"referee, {cells:2d} cells" + "   ".join(f"{force:7.5f}" for force in expected) + " N"
        )
    for cells in (8, 12):
        for fine in (True, False):
            found = pressed(cells, fine=fine)
            ratios = [force / other for force, other in zip(found, expected, strict=True)]
            for depth, ratio in zip(DEPTHS, ratios, strict=True):
                claimed = depth <= LARGEST_CLAIMED_DEPTH * (1 + 1e-9)
                largest = LARGEST_ERROR if fine else LARGEST_ERROR_OWN
                held &= not claimed or abs(ratio - 1) <= largest
            which = "fine points" if fine else "own points"
            print(f"Palpate / referee, {cells:2d} cells, {which:11s}", np.round(ratios, 3))
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


def pressed(cells: int, *, fine: bool) -> list[float]:
    """Palpate's forces on the sphere, newton, for a cube of so many cells."""
    mesh, fixed = paper_cube(EDGE, cells)
    compliance = surface_compliance(mesh, assemble(mesh, POISSON_RATIO), fixed)
    body = SoftBody(mesh, fixed, POISSON_RATIO, compliance, YOUNG_MODULUS)
    surface = correction = None
    if fine:
        every = contact_points(body, FINE_SPACING)
        middle = np.array([EDGE / 2, EDGE / 2, EDGE])
        surface = every.taken(np.linalg.norm(every.positions - middle, axis=1) < RADIUS)
        correction = near_correction(body, surface)
    forces = []
    for depth in DEPTHS:
        pose = Pose.at([EDGE / 2, EDGE / 2, EDGE + RADIUS - depth])
        touch = press_tool(body, sphere(RADIUS), pose, surface=surface, correction=correction)
        forces.append(float(touch.force[2]))
    return forces


if __name__ == "__main__":
    sys.exit(main())
