"""The ball of a durometer 00 deep in neo-Hookean rubber: the fitted force beside finite elements.

    python benchmarks/contact/rubber_ball.py

Printed is the force over Hertz's at depths up to that of a reading of 10, 1.9 radii: by scikit-fem
(:mod:`palpate.benchmarks.measuring.contact.pressed_cylinder`), and by ``rubber_ball_force``.

Claimed: they agree within 1.5 %. The exit status tells whether that holds. Takes five minutes, more
on a busy machine, which changes nothing else.
"""

from __future__ import annotations

import sys

import numpy as np

from palpate.benchmarks.measuring.contact.pressed_cylinder import PressedCylinder
from palpate.core.softness.scales.indentation import hertz_force, rubber_ball_force

DEPTHS = (0.2, 0.4, 0.6, 0.75, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9)
LARGEST_DIFFERENCE = 0.015


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    rubber = PressedCylinder()
    found = rubber.forces(DEPTHS) * (1 - rubber.poisson_ratio**2)
    print(f"{'depth/radius':>12s}{'finite elements':>17s}{'fit':>9s}")
    worst = 0.0
    for depth, force in zip(DEPTHS, found, strict=True):
        hertz, fit = hertz_force(1.0, depth), rubber_ball_force(1.0, depth)
        worst = max(worst, abs(fit / force - 1))
        print(f"{depth:12.2f}{force / hertz:17.4f}{fit / hertz:9.4f}")
    held = bool(np.isfinite(worst) and worst <= LARGEST_DIFFERENCE)
    print(f"largest difference {worst:.2%}")
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
