"""What a press by the material's own law costs on a body nearly as large as is felt.

    python benchmarks/shape/press_cost.py [--cells N]

A cube of so many cells along an edge, smoothed strains, a Poisson's ratio of 0.45, under a ball of
12 mm and a point; seconds, and by how much the process grows at most, linear touches beside.
Claimed: every press is at rest, and takes less than 30 s (on a busy machine, too). The exit status
tells.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from palpate.benchmarks.measuring.memory import with_peak
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.single_press import press_tool, touch_nearest
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.contact.touches import Touch
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.felt import felt
from palpate.core.shape.shapes import Shape, shape
from palpate.tests.bodies.baked_body import baked_body

TOP, DEPTHS, RADIUS = (0.025, 0.025, 0.05), (0.003, 0.006, 0.012), 0.012
LONGEST = 30.0


def main() -> int:
    """Print the figures; 1 where the claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cells", type=int, default=16, metavar="N", help="along an edge")
    mesh, fixed = paper_cube(cells=parser.parse_args().cells)
    body, grown = with_peak(lambda: baked_body(mesh, fixed, 0.45, 1.0, "smoothed"))
    print(f"{len(mesh.nodes) - len(fixed)} free nodes; the bake takes {grown / 1e6:.0f} MB")
    begun = time.perf_counter()
    real, grown = with_peak(lambda: _prepared(body))
    took = time.perf_counter() - begun
    print(f"prepared in {took:.1f} s, {grown / 1e6:.0f} MB more", flush=True)
    kept = []
    for depth in DEPTHS:
        for name, touched in TOUCHES.items():
            begun = time.perf_counter()
            touch = touched(body, depth)
            linear = time.perf_counter()
            pressed, grown = with_peak(partial(felt, real, [touch], 1.0))
            took, found = time.perf_counter() - linear, pressed.firmness
            kept.append(found.is_whole and took < LONGEST)
            print(
                f"{name:<6}{1e3 * depth:5.0f} mm{linear - begun:8.2f} s linear{took:8.2f} s,"
                f" {grown / 1e6:.0f} MB more, G {found.deepest:.3f}",
                flush=True,
            )
    real.close()
    print("the claim holds" if all(kept) else "the claim does NOT hold")
    return 0 if all(kept) else 1


def _ball(body: SoftBody, depth: float) -> Touch:
    pose = Pose.at([*TOP[:2], TOP[2] + RADIUS - depth])
    return press_tool(body, sphere(RADIUS), pose)


def _point(body: SoftBody, depth: float) -> Touch:
    return touch_nearest(body, TOP, (0.0, 0.0, -depth))


TOUCHES: dict[str, Callable[[SoftBody, float], Touch]] = {"ball": _ball, "point": _point}


def _prepared(body: SoftBody) -> Shape:
    made = shape(body, "real")
    made.wait_for(np.zeros(0, dtype=np.int64))
    return made


if __name__ == "__main__":
    sys.exit(main())
