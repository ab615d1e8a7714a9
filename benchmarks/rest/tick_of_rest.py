"""What a tick takes of a free body on a floor with a fingertip on it, and how far it is exact.

    python benchmarks/rest/tick_of_rest.py [--cells N] [--ticks N]

A cube of 50 mm with about 1,700 nodes lies on a floor with friction; a fingertip of 8 mm lands on
it, slides and leaves. First by `Resting`: ticks are hurried, bounded as the servo's are; times are
those of one call, from outside, with all forces read by nobody. Then by the servo's own whole
ticks, the processor's time of each, the least of five rounds: what a tick computes is the same each
time, and what else the machine does is not. Claimed: 300 us at the median, 700 at the worst.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np
from palpate_servo.harness import SteppedFingers

from palpate.benchmarks.measuring.servo.timed_rounds import timed_rounds
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.servo.session import native_body, native_prop, native_tool
from palpate.core.servo.settings import Settings
from palpate.tests.bodies.free_shapes import free_block

DT = 1e-3
TIP = sphere(0.008)
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
        tip = (TIP, Pose.at(places[0]))
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
        rounds = 1e6 * servo_costs(body, places, settings)
        took = rounds.min(axis=0)
        median, most = np.median(took), np.max(took)
        print(
            f"  in the servo: median {median:.0f} us, 99.9 % {np.quantile(took, 0.999):.0f}, "
            f"worst {most:.0f} (of all rounds {np.median(rounds):.0f}, {rounds.max():.0f})"
        )
        failed = failed or median > MEDIAN or most > WORST
    return int(failed)


def servo_costs(body: SoftBody, places: np.ndarray, settings: RestSettings) -> np.ndarray:
    """Processor's time of each tick (rounds, ticks), s, the body having come to rest before."""
    friction = settings.friction
    native = native_body(body, whole=True, may_move=True)
    feel = Settings(body.young_modulus, static_friction=friction, dynamic_friction=friction)
    prop = native_prop(body, native, [Floor(friction=friction)], settings=settings)

    def rested() -> SteppedFingers:
        fingers = SteppedFingers(native, places[:1], feel, prop=prop)
        fingers.set_tool(native_tool(body, native, TIP), np.eye(3))
        fingers.follow(np.repeat(places[:1], 300, 0)[:, None])
        return fingers

    return timed_rounds(rested, places[:, None])[0]


if __name__ == "__main__":
    sys.exit(main())
