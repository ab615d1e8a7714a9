"""Hands that press a real host's body."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

from ...hand.plant import Vector
from ..target import ABOVE, DEEP
from .host import Host, eventually


class Hand(Protocol):
    """A device that is told where its hand goes, and tells what it feels."""

    port: str

    def move_hand(self, position: Vector, seconds: float) -> None:
        """Bring the hand to `position` (m) in `seconds`."""

    def report(self) -> dict[str, Any]:
        """Present state (see `SimulatedDevice.report`)."""


@dataclass(frozen=True)
class Way:
    """A hand's way into the body and out, metres, and how long each takes, s."""

    above: tuple[float, float, float]
    deep: tuple[float, float, float]
    seconds: float


INTO_THE_CUBE = Way(ABOVE, DEEP, 0.1)
INSIDE = "inside the body"
FELT = 0.3
"""N."""
PRESSES = 5


def press(host: Host, hand: Hand, way: Way = INTO_THE_CUBE) -> None:
    """Bring the hand into the cube, out of it first.

    A machine that is held up meanwhile has the probe set down inside of the body: then again.
    """

    def stands() -> str:
        report = host.report()
        if (
            report["state"] == "touching"
            and report["limited"] != "ramp"
            and report["output"] > FELT
        ):
            return "felt"
        return str(report["reason"] or report["state"])

    for _ in range(PRESSES):
        hand.move_hand(way.above, way.seconds)
        eventually(lambda: stands() == "free", "nothing is touched")
        hand.move_hand(way.deep, way.seconds)
        eventually(lambda: stands() in ("felt", INSIDE), "the cube is felt")
        if stands() == "felt":
            break
    eventually(lambda: stands() == "felt", "the cube is felt")
    eventually(lambda: strength(hand.report()) > FELT, "the device pushes")


def strength(report: dict[str, Any]) -> float:
    """Of the force that the hand feels, N."""
    return math.hypot(*report["felt_force"])
