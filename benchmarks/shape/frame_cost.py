"""What a drawn frame costs in every shape, in its parts.

    python benchmarks/shape/frame_cost.py [--quick] [--shapes linear paper ...]

For ``mouse-1.7k`` and ``mouse-20k``, under touches of 3 mm in the middle of random triangles, one
after the other, with all at hand that the shapes prepare in the background:

- prepare: seconds until the first touch is drawn as it should be, from a body just loaded;
- shape: the displacements of the free surface nodes, every frame;
- draw: to 100,000 vertices (``DrawnMap``), as coordinates, written into
  Blender's shape key;
- frame: all of it.

Times are the thread's processor time, medians, so that other programs count only by the caches and
the memory they take; ``clock`` is the median by the clock.

Claim: a frame takes no more than 10 ms at 1.7k nodes, and 16 ms at 20k. ``--quick`` leaves out
``mouse-20k``, whose body is baked first and kept in build/frame-cost.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from palpate.benchmarks.measuring.bodies import MeasuredBody, stored_body
from palpate.benchmarks.measuring.shape.drawn_frame import (
    DRAWN_VERTICES,
    Load,
    blender_write_seconds,
    drawn_coordinates,
    hung_vertices,
    in_turn,
    random_loads,
)
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body import body_file
from palpate.core.body.soft_body import SoftBody
from palpate.core.shape.shapes import MAKERS, SHAPES, ShapeName, shape
from palpate.core.stiffness.pins import PinNodes

KEPT = Path(__file__).resolve().parents[2] / "build" / "frame-cost"
TOUCHES = 3
FRAMES = 60
# Seconds of a frame that are claimed.
LARGEST_FRAME = {"mouse-1.7k": 0.010, "mouse-20k": 0.016}
FEW_NODES = 2000


def baked(measured: MeasuredBody) -> SoftBody:
    """The body with its compliance, from the folder where it is kept or baked now."""
    file = KEPT / f"{measured.name}.npz"
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        settings = BakeSettings(0.3, 1000.0, PinNodes(measured.fixed))
        body_file.save(bake(measured.mesh, settings)[0], file)
    return body_file.load(file)


def median_times(work: Callable[[], object], frames: int) -> tuple[float, float]:
    """Median seconds of a call by the processor and by the clock, after one that does not count."""
    work()
    times = np.empty((frames, 2))
    for row in times:
        start = time.thread_time(), time.perf_counter()
        work()
        row[:] = time.thread_time() - start[0], time.perf_counter() - start[1]
    processor, clock = np.median(times, axis=0).tolist()
    return processor, clock


def draw_seconds(body: SoftBody) -> float:
    """What follows the displacements in a frame, by the processor; Blender's write by the clock."""
    hung = hung_vertices(body)
    rest = np.zeros(3 * DRAWN_VERTICES, dtype=np.float32)
    still = np.zeros((body.compliance.node_count, 3))
    processor, _ = median_times(lambda: drawn_coordinates(rest, hung.displacements(still)), 30)
    return processor + (blender_write_seconds() or 0.0)


def measure(body: SoftBody, name: ShapeName, touches: list[Load], draw: float) -> float:
    """Print a row for a shape; returns the seconds of a frame."""
    start = time.perf_counter()
    made = shape(body, name)
    made.wait_for(touches[0].triangle)
    made.displacements(touches[0].triangle, touches[0].nodal_forces)
    prepare = time.perf_counter() - start
    try:
        for touch in touches:
            made.wait_for(touch.triangle)
        frame = in_turn(touches, lambda load: made.displacements(load.triangle, load.nodal_forces))
        few = len(body.mesh.nodes) > FEW_NODES
        processor, clock = median_times(frame, FRAMES // 6 if few else FRAMES)
    finally:
        made.close()
    times = [1e3 * seconds for seconds in (processor, draw, processor + draw, clock)]
    print(
        f"  {name:<17}{prepare:>9.2f} s" + "".join(f"{each:>10.2f}" for each in times), flush=True
    )
    return processor + draw


def main() -> int:
    """Print the table; 1 where the claim does not hold."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="leave out mouse-20k")
    parser.add_argument("--shapes", nargs="+", choices=list(MAKERS), default=list(MAKERS))
    options = parser.parse_args()
    names = list(LARGEST_FRAME)[: 1 if options.quick else None]
    is_kept = True
    for body_name in names:
        body = baked(stored_body(body_name))
        nodes = len(body.mesh.nodes)
        print(f"{body_name}: {nodes} nodes, {len(body.mesh.tets)} tetrahedra; ms")
        columns = ("shape", "draw", "frame", "clock")
        print(f"  {'':<17}{'prepare':>11}" + "".join(f"{each:>10}" for each in columns))
        touches, draw = random_loads(body, TOUCHES), draw_seconds(body)
        for name in SHAPES:
            if name not in options.shapes:
                continue
            seconds = measure(body, name, touches, draw)
            if seconds > LARGEST_FRAME[body_name]:
                most = 1e3 * LARGEST_FRAME[body_name]
                print(f"CLAIM BROKEN: {name} takes more than {most:.0f} ms a frame")
                is_kept = False
    print("the claim holds" if is_kept else "the claim does NOT hold, see above")
    return 0 if is_kept else 1


if __name__ == "__main__":
    sys.exit(main())
