"""What a tick takes of a free body on a floor with a fingertip on it, and how far it is exact.

    python benchmarks/rest/tick_of_rest.py [--cells N] [--ticks N]

A cube of 50 mm with about 1,700 nodes lies on a floor with friction; a fingertip of 8 mm lands on
it, slides and leaves. Ticks are hurried: bounded as the servo's are. Times are those of one
call, from outside, with all forces read by nobody. Claimed: 300 us at the median, 700 at the worst.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.resting import Resting, RestSettings
from palpate.core.rest.support import Floor
from palpate.tests.bodies.free_shapes import free_block

DT = 1e-3
MEDIAN, WORST = 300.0, 700.0


def path(ticks: int) -> np.ndarray:
    """Places of the fingertip's centre, (ticks, 3), m."""
    share = np.linspace(0.0, 1.0, ticks)
    depth = 0.004 * np.sin(np.pi * share)
    along = 0.018 + 0.014 * share
    return np.column_stack([along, np.full(ticks, 0.024), 0.05 + 0.0085 - depth])


def main() -> int:
    """Prints times; the exit status tells whether the median is as claimed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=11)
    parser.add_argument("--ticks", type=int, default=2000)
    options = parser.parse_args()
    body = free_block((0.05, 0.05, 0.05), (options.cells,) * 3, young_modulus=30_000.0)
    print(f"{len(body.mesh.nodes)} nodes, {len(body.compliance.free_surface)} on the surface")
    failed = False
    for friction in (0.0, 0.5):
        settings = RestSettings(friction=friction)
        places = path(options.ticks)
        tip = (sphere(0.008), Pose.at(places[0]))
        resting = Resting(body, [Floor(friction=friction)], [tip], settings=settings)
        resting.settle()
        took, points = [], []
        for place in places:
            resting.lead([Pose.at(place)])
            start = time.perf_counter()
            resting.tick(DT, hurried=True)
            took.append(1e6 * (time.perf_counter() - start))
            rest = resting.rest
            points.append(sum(len(touch.pushes) for touch in (*rest.tools, *rest.supports)))
        median, most = np.median(took), np.max(took)
        print(
            f"friction {friction}: median {median:.0f} us, 99.9 % {np.quantile(took, 0.999):.0f}, "
            f"worst {most:.0f}; {int(np.median(points))} pressed points, {max(points)} at most"
        )
        failed = failed or median > MEDIAN
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
