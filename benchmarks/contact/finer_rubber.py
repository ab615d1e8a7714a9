"""What a mesh can tell of a ball pressed into rubber: its own equilibrium beside a finer mesh's.

    python benchmarks/contact/finer_rubber.py

A cube of 6 cells an edge and one of 12 are pressed by the same balls, aside of their nodes, to
three quarters of a radius: by a contact of Newton's method
(:mod:`palpate.benchmarks.measuring.shape.pressed_solid`) on either mesh, and on the coarse one as
*Real* feels and draws it and as *Linear* does. Printed are the force of the fine mesh at 1 Pa, mm2,
and how far the others are off it: force, and drawn surface, root of the mean square of all that
moves on the top of the fine mesh.

Claimed: *Real*'s force is within 10 % of the fine mesh's, and its surface no farther off than the
coarse mesh's own equilibrium (by 2 %). The exit status tells whether that holds. Takes two minutes,
more on a busy machine.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed_solid import Ball, Pressed, PressedSolid
from palpate.core.body.drawn_map import DrawnMap
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.felt import felt, loads_of
from palpate.core.shape.meeting import settled
from palpate.core.shape.shapes import shape
from palpate.tests.bodies.baked_body import baked_body
from palpate.tests.bodies.bare_body import bare_body

Array = NDArray[np.float64]

EDGE, COARSE, FINE = 0.05, 6, 12
POISSON_RATIO = 0.45
PLACE = np.array([0.026, 0.0235, EDGE])
OUTWARD = np.array([0.0, 0.0, 1.0])
# 1.4 and 1.9 usual edges of the coarse mesh.
RADII, DEPTHS = (0.012, 0.016), (0.25, 0.5, 0.75)
FORCE, NO_FARTHER = 0.10, 1.02


def pressed(rubber: PressedSolid, radius: float) -> Iterator[Pressed]:
    """A body under a ball, to each depth."""
    middles = [PLACE + (1.0 - depth) * radius * OUTWARD for depth in DEPTHS]
    return rubber.by_tools([Ball(middle, radius) for middle in middles], OUTWARD)


def main() -> int:
    """Print the table; the exit status tells whether the claims hold."""
    coarse = baked_body(*paper_cube(EDGE, COARSE), POISSON_RATIO, 1.0, "smoothed")
    own = PressedSolid(coarse)
    fine = PressedSolid(bare_body(*paper_cube(EDGE, FINE), POISSON_RATIO, "smoothed"))
    top = np.flatnonzero(fine.solid.positions[:, 2] > EDGE - 1e-9)
    drawn = DrawnMap.hang(fine.solid.positions[top], coarse)
    real = shape(coarse, "real")
    print(f"{'ball':>16}{'depth':>7}{'fine':>8}   force off, %: own, real, linear   drawn off, %")
    holds = True
    for radius in RADII:
        both = zip(DEPTHS, pressed(fine, radius), pressed(own, radius), strict=True)
        for depth, true, same in both:
            tool = Pose.at(PLACE + (1.0 - depth) * radius * OUTWARD)
            touch = press_tool(coarse, sphere(radius), tool)
            met = settled(coarse, real, loads_of([touch]), 1.0)
            force = float(true.force[2])
            forces = [
                float(by.force[2]) / force - 1.0
                for by in (same, felt(real, [touch], 1.0).touches[0], touch)
            ]
            # A touch tells what it does to the finger.
            forces[1:] = [-2.0 - off for off in forces[1:]]
            moved = true.displacements[top]
            shown = (same.displacements[own.solid.surface], met.displacements, met.linear)
            errors = [
                float(np.linalg.norm(drawn.displacements(one) - moved) / np.linalg.norm(moved))
                for one in shown
            ]
            cells = "".join(f"{100 * off:+8.1f}" for off in forces)
            cells += "  " + "".join(f"{100 * off:8.1f}" for off in errors)
            ball = f"{1e3 * radius:10.0f} mm {radius / own.edge:.2f}{depth:7.2f}"
            print(f"{ball}{-1e6 * force:8.2f}{cells}", flush=True)
            holds = holds and abs(forces[1]) <= FORCE and errors[1] <= NO_FARTHER * errors[0]
    real.close()
    print("the claims hold" if holds else "a claim does NOT hold")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
