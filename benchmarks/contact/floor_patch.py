"""A ball on a floor pressed by a sphere: force, and how wide the floor presses, by two codes.

    python benchmarks/contact/floor_patch.py [--cells N]

The referee is scikit-fem, axially symmetric, with its own contact at sphere and table
(``benchmarks/measuring/contact/resting_ball.py``). Of a patch both tell the same number, which does
not depend on how finely it is sampled: the root of the mean square of the distance from the axis,
weighed by the pressure. A ball of 60 mm, Poisson's ratio 0.3, of linear elements, without weight,
is pressed by one of 30 mm, by 2 to 6 mm. Claimed: all within 3 %; the exit status tells whether
they are.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np

from palpate.benchmarks.measuring.contact.resting_ball import RestingBall
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.bearing_points import bearing_points
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.tests.bodies.free_shapes import free_ball

RADIUS, TIP, YOUNG, POISSON = 0.03, 0.015, 1e4, 0.3
DEPTHS = (0.002, 0.004, 0.006)
MOST_ERROR, FRICTION = 0.03, 0.05


def main() -> int:
    """Print the table; the exit status tells whether the claim holds."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--cells", type=int, default=10)
    body = free_ball(RADIUS, parser.parse_args().cells, young_modulus=YOUNG)
    points, _ = bearing_points(body)
    centre = np.array([0.0, 0.0, RADIUS])
    radius = float(np.linalg.norm(points.positions - centre, axis=1).mean())
    top = RADIUS + radius
    weightless = RestSettings(friction=FRICTION, gravity=(0.0, 0.0, -1e-6))
    start = Pose.at([0.0, 0.0, top + TIP + 1e-5])
    resting = Resting(
        body,
        [Floor(RADIUS - radius, friction=FRICTION)],
        [(sphere(TIP), start)],
        settings=weightless,
    )
    resting.step()
    referee = RestingBall(POISSON)
    print(f"{len(body.mesh.nodes)} nodes, {len(points)} contact points; Palpate / referee")
    print("depth, mm    force   floor's force   width of its patch")
    held = True
    for depth in DEPTHS:
        force, width = referee.spread_under_sphere(TIP / radius, depth / radius)
        resting.lead([Pose.at([0.0, 0.0, top + TIP - depth])])
        rest = resting.settle()
        (floor,) = rest.supports
        middle = floor.pushes @ floor.places[:, :2] / floor.pushes.sum()
        square = ((floor.places[:, :2] - middle) ** 2).sum(axis=1)
        wide = float(np.sqrt(floor.pushes @ square / floor.pushes.sum()))
        unit = YOUNG * radius**2
        ratios = np.array(
            [
                rest.tools[0].force[2] / (force * unit),
                -floor.force[2] / (force * unit),
                wide / (width * radius),
            ]
        )
        print(f"{1e3 * depth:9.1f}  {ratios.round(4)}", flush=True)
        held &= bool((np.abs(ratios - 1.0) <= MOST_ERROR).all())
    print("the claim holds" if held else "THE CLAIM DOES NOT HOLD")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
