"""What is felt while a press goes in for the first time, and when it comes again.

    python benchmarks/servo/first_press.py [--bodies cube mouse ...] [--laws rubber foam ...]

How firm a body of its law is, is found in the background while a finger is on its way. A point and
a ball of 8 mm are led 8.2 mm deep in 1.2 s, rest, go out and come again, in real time; the force of
each frame beside that of the same depth, looked for by itself without a clock. Columns are percent
of the force in the end: how far off at most on the way in, and on the linear body; how far off
0.15, 0.3 and 0.6 s after it came to rest; and at most on the way out and in again.

Claimed: 12 on the way in (foam 35: it yields while it is looked for), 8 at rest, and 10 afterwards.
The exit status tells.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.deep_press import LAWS, Bench
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.place import nearest_place
from palpate.core.contact.single_press import press_tool, touch_at
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, sphere
from palpate.core.contact.touches import Touch
from palpate.core.servo.firming import Firming
from palpate.core.servo.session import Pointer, native_body, native_tool, servo_on
from palpate.core.servo.settings import Settings
from palpate.core.shape.felt import felt
from palpate.core.shape.shapes import Shape

Array = NDArray[np.float64]

# Places, of the body's box from below; where the nearest surface is pressed.
BODIES = {"cube": (0.5, 0.5, 1.0), "mouse-1.7k": (0.4, 0.3, 1.0), "drumstick": (0.5, 0.5, 1.0)}
DEPTH, RADIUS = 0.0082, 0.008
# Seconds and shares of the depth; straight, but for the ease at either end.
WAY = (
    (0.0, -0.3),
    (0.3, 0.0),
    (1.5, 1.0),
    (2.3, 1.0),
    (3.3, -0.1),
    (3.5, -0.1),
    (4.7, 1.0),
    (5.0, 1.0),
)
IN, RESTS, AGAIN = 0.3, 1.5, 2.3
AFTER = (0.15, 0.3, 0.6)
FRAME = 1.0 / 60.0
LOOKS = 14
MOST_IN, MOST_IN_FOAM, MOST_AT_REST, MOST_AFTERWARDS = 12.0, 35.0, 8.0, 10.0


@dataclass(frozen=True, eq=False)
class Pressing:
    """A place of a body, the way in, and what goes in: a ball, or a point."""

    body: SoftBody
    shape: Shape
    place: Array
    inward: Array
    triangle: int
    alpha: Array
    tool: Tool | None

    def at(self, depth: float) -> Array:
        """Where the point or the ball's middle is, metres."""
        radius = 0.0 if self.tool is None else RADIUS
        return self.place + (depth - radius) * self.inward

    def touch(self, depth: float) -> Touch:
        """The linear body's."""
        if self.tool is None:
            return touch_at(self.body, self.triangle, self.alpha, depth * self.inward)
        return press_tool(self.body, self.tool, Pose.at(self.at(depth)))

    def shares(self) -> tuple[Array, Array]:
        """Depths (k,), and how firm the law is there (k,)."""
        depths = DEPTH * np.linspace(0.0, 1.0, LOOKS + 1)
        found = [
            felt(self.shape, [self.touch(depth)], self.body.young_modulus).firmness.deepest
            for depth in depths[1:]
        ]
        return depths, np.array([1.0, *found])

    def led(self) -> Array:
        """Seconds, depth, force and firmness (frames, 4) of a run in real time."""
        modulus, touched = self.body.young_modulus, native_body(self.body, whole=True)
        servo = servo_on(touched, Settings(modulus, max_force=1e3))
        if self.tool is not None:
            servo.set_tool(native_tool(self.body, touched, self.tool))
        firming = Firming(servo, self.body, self.tool)
        servo.start(Pointer(self.at(depth_at(0.0))))
        found = []
        begun = time.perf_counter()
        try:
            while (now := time.perf_counter() - begun) < WAY[-1][0]:
                servo.set_target(self.at(depth_at(now)))
                shot = servo.snapshot()
                firming.follow(shot, self.shape, modulus)
                depth = float((shot.probe - self.at(0.0)) @ self.inward)
                force = float(np.linalg.norm(shot.contact_force))
                found.append((now, depth, force, shot.firmness))
                time.sleep(FRAME)
        finally:
            servo.stop()
            firming.close()
        return np.array(found)


def depth_at(seconds: float) -> float:
    """How deep the finger is led, metres."""
    times, shares = np.array(WAY).T
    return DEPTH * float(np.interp(seconds, times, shares))


def pressing(bench: Bench, place: tuple[float, float, float], tool: Tool | None) -> Pressing:
    """On the surface nearest to a place of the body's box."""
    nodes = bench.body.mesh.nodes
    near = nodes.min(axis=0) + np.array(place) * np.ptp(nodes, axis=0)
    found = nearest_place(bench.body, near)
    return Pressing(
        bench.body, bench.shape, found.position, found.axis, found.triangle, found.alpha, tool
    )


def off(told: Array, depths: Array, shares: Array) -> tuple[list[float], float]:
    """On the way in, at rest after some times, afterwards; and of a linear body on the way in."""
    seconds, depth, force, firm = told.T
    linear = force / firm
    end = linear[seconds > WAY[-1][0] - 0.1].mean() * shares[-1]
    law = np.interp(depth, depths, shares)
    apart, of_linear = (100.0 * linear * np.abs(one - law) / end for one in (firm, 1.0))
    is_in = (seconds > IN) & (seconds < RESTS)
    at_rest = [float(apart[np.argmin(np.abs(seconds - RESTS - one))]) for one in AFTER]
    afterwards = float(apart[seconds > AGAIN].max())
    return [float(apart[is_in].max()), *at_rest, afterwards], float(of_linear[is_in].max())


def main() -> int:
    """Print the figures; 1 where the claim does not hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=list(BODIES), choices=list(BODIES))
    parser.add_argument("--laws", nargs="+", default=list(LAWS), choices=list(LAWS))
    chosen = parser.parse_args()
    heads = ("on the way in", *(f"after {one:g} s" for one in AFTER), "afterwards", "linear")
    print(" " * 36 + "".join(f"{head:>15}" for head in heads))
    kept = True
    for name in chosen.bodies:
        for law in chosen.laws:
            bench = Bench.of(name, law)
            most_in = MOST_IN_FOAM if law == "foam" else MOST_IN
            most = np.array([most_in, *[MOST_AT_REST] * len(AFTER), MOST_AFTERWARDS])
            for tip, tool in (("point", None), ("ball", sphere(RADIUS))):
                one = pressing(bench, BODIES[name], tool)
                found, linear = off(one.led(), *one.shares())
                kept = kept and bool((np.array(found) <= most).all())
                figures = "".join(f"{figure:15.1f}" for figure in (*found, linear))
                print(f"{name:<12}{law:<16}{tip:<8}{figures}", flush=True)
    print("the claim holds" if kept else "the claim does NOT hold")
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
