"""Tips of the servo, led round loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedFingers

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.native_tool import NativeTip, native_tool
from palpate.core.contact.tool.tools import Tool
from palpate.core.servo.settings import Settings
from palpate.tests.ways.told_firmness import LINEAR, Told

from .energy_loops import ROUND, Follow, Loop

Vectors = NDArray[np.float64]

# Ticks after which another firmness comes: of four each comes as often in every round.
CHANGED = ROUND // 16


@dataclass(frozen=True)
class Tip:
    """A tip of a finger, a point by default.

    Attributes
    ----------
    made : a tool; None for a point.
    front : metres, from a tool's reference point to its foremost one.
    """

    made: NativeTip | None = None
    front: float = 0.0


def tip_of(body: SoftBody, native: Body, tool: Tool) -> Tip:
    """A tool, made for a body."""
    front = tool.radius if len(tool.core) <= 2 else 0.0
    return Tip(native_tool(body, native, tool), front)


def led(
    native: Body,
    settings: Settings,
    loops: Sequence[Loop],
    tips: Sequence[Tip],
    motors: float | None = None,
    firmnesses: Sequence[Told] = (LINEAR,),
) -> Follow:
    """A finger for each loop, set down in the air where that begins: its front is led, and looks
    where the way goes in.

    ``motors`` bear so much, newton; None without motors. ``firmnesses`` are as `set_firmness` takes
    one, each for CHANGED ticks and then the next, over and over.
    """
    raised = np.array([tip.front * loop.normal for tip, loop in zip(tips, loops, strict=True)])
    starts = np.array([loop.press[0] for loop in loops]) + raised
    fingers = SteppedFingers(native, starts, settings, max_force=motors)
    coming = cycle(firmnesses)
    for number, (tip, loop) in enumerate(zip(tips, loops, strict=True)):
        if tip.made is not None:
            fingers.set_tool(tip.made, _facing(loop.normal).tolist(), number)

    def follow(path: Vectors) -> tuple[Vectors, Vectors]:
        sent = []
        for begin in range(0, len(path), CHANGED):
            fingers.set_firmness(*next(coming))
            sent.append(fingers.sent(path[begin : begin + CHANGED] + raised))
        forces = np.concatenate(sent)
        shots = fingers.snapshot().fingers
        return forces, np.array([_place(shot) for shot in shots])

    return follow


def _facing(normal: Vectors) -> Vectors:
    """A rotation (3, 3) whose third axis is the normal."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(normal, first), normal])


def _place(shot) -> Vectors:
    """Where a finger presses, metres: its contact point, or the middle of a tool's pressure."""
    if not len(shot.points):
        return np.asarray(shot.proxy)
    weights = np.linalg.norm(shot.point_forces, axis=1)
    return np.average(shot.points, axis=0, weights=weights)
