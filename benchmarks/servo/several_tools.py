"""Ticks of a servo with several tools on the paper's cube: rows of `tick_cost`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedFingers

from palpate.benchmarks.measuring.servo.timed_rounds import timed_rounds
from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.tools import Tool, plate, sphere
from palpate.core.servo.session import native_tool
from palpate.core.servo.settings import Settings

Floats = NDArray[np.float64]

# Edge of the cube, m.
EDGE = 0.05
FRICTION = 0.4
# Where the tools come from, m, and in how many ticks.
FROM = 0.02
WAY_IN = 300
# The same path so many times.
ROUNDS = 4


@dataclass(frozen=True, eq=False)
class Together:
    """Some tools of a kind.

    Attributes
    ----------
    tool : of each finger.
    rotations : (m, 3, 3), tool to body.
    middles : (m, 3), m, the references' places at no depth, about which they go.
    depth : m.
    aside : (2, 3), m: how far they go to and fro.
    claims : median us of a tick without friction and with.
    """

    name: str
    tool: Tool
    rotations: Floats
    middles: Floats
    depth: float
    aside: Floats
    claims: tuple[float, float]

    def path(self, ticks: int) -> Floats:
        """Places (ticks, m, 3): to and fro at some mm/s, up and down about the depth."""
        seconds = np.arange(ticks) * 1e-3
        pressed = self.depth * (0.85 + 0.15 * np.sin(9.0 * seconds))
        along = np.sin(np.outer(seconds, [2.0, 2.6])) @ self.aside
        inwards = -self.rotations[:, :, 2]
        return self.middles + along[:, None] + pressed[:, None, None] * inwards


def all_together() -> tuple[Together, ...]:
    """Four fingertips of 40 points on the top, and two plates on neighbouring sides."""
    upright = np.eye(3)
    on_its_side = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    radius, near, far = 0.008, 0.013, EDGE - 0.013
    tips = [[x, y, EDGE + radius] for x in (near, far) for y in (near, far)]
    plates = [[EDGE / 2, EDGE / 2, EDGE], [EDGE / 2, EDGE, EDGE / 2]]
    return (
        Together(
            "four fingertips",
            sphere(radius),
            np.array([upright] * 4),
            np.array(tips),
            0.005,
            np.array([[0.003, 0.0, 0.0], [0.0, 0.003, 0.0]]),
            (500.0, 750.0),
        ),
        Together(
            "two plates, deep",
            plate(0.016, 0.016),
            np.array([upright, on_its_side]),
            np.array(plates),
            0.003,
            np.array([[0.004, 0.0, 0.0], [0.0, 0.0, 0.0]]),
            (570.0, 660.0),
        ),
    )


def costs(
    body: SoftBody, surface: Body, together: Together, friction: float, ticks: int
) -> tuple[Floats, list[int]]:
    """CPU us of each tick, and how many points each tool presses at the end."""
    path = together.path(ticks)
    out = np.linspace(FROM, 0.0, WAY_IN)[:, None, None] * together.rotations[:, :, 2]
    way_in = path[0] + out
    settings = Settings(body.young_modulus, static_friction=friction, dynamic_friction=friction)
    tool = native_tool(body, surface, together.tool)

    def come() -> SteppedFingers:
        fingers = SteppedFingers(surface, way_in[0], settings)
        for finger, rotation in enumerate(together.rotations):
            fingers.set_tool(tool, rotation.tolist(), finger)
        fingers.costs(way_in)
        return fingers

    taken, fingers = timed_rounds(come, path, ROUNDS)
    pressed = [len(shot.points) for shot in fingers.snapshot().fingers]
    return 1e6 * taken.min(axis=0), pressed


def print_several(body: SoftBody, surface: Body, ticks: int) -> bool:
    """Ticks of several tools; whether the claims hold."""
    print("\nwhole ticks with several tools, us of CPU, the least of some rounds")
    print(f"{'tools':<18}{'friction':>9}  {'pressed':<16}{'median':>8}{'longest':>9}{'claim':>7}")
    holds = True
    for together in all_together():
        for friction, claim in zip((0.0, FRICTION), together.claims, strict=True):
            taken, pressed = costs(body, surface, together, friction, ticks)
            median = float(np.median(taken))
            counts = " ".join(map(str, pressed))
            print(
                f"{together.name:<18}{friction:>9g}  {counts:<16}{median:>8.0f}{taken.max():>9.0f}"
                f"{claim:>7.0f}",
                flush=True,
            )
            holds &= median <= claim
    return holds
