"""The servo's own ticks without a clock, where the native module was built with them."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Protocol, cast

from ..errors import PalpateError
from .settings import Settings

if TYPE_CHECKING:
    from palpate_servo import Body, FingerCounters, Snapshot

_HARNESS = "palpate_servo.harness"


class SteppedServo(Protocol):
    """A servo whose ticks are made by hand, its line in memory; else as ``palpate_servo.Servo``."""

    def tick(self, received: bytes, seconds: float, taken: int | None) -> bytes:
        """One tick so long after the last; returns what the device takes of what was sent.

        That is at most ``taken`` bytes (None: all); the rest waits in a driver.
        """

    def unplug(self) -> None:
        """Take the line away, with what is on it."""

    def plug_in(self) -> None:
        """Bring it back."""

    def set(self, settings: Settings) -> None:
        """As of a servo, but for a modulus that is no number, which the tick has to find."""

    def set_body(self, body: Body, settings: Settings) -> None:
        """As of a servo; taken with the next tick."""

    def snapshot(self) -> Snapshot:
        """The last tick."""

    def counters(self) -> FingerCounters:
        """Faults and line."""


def stepped_servo(
    body: Body,
    settings: Settings,
    *,
    max_force: float,
    max_slew: float,
    ramp_seconds: float,
    haply: str | None = None,
) -> SteppedServo:
    """Servo at 1 kHz; its device speaks the link, or is the Haply 2DIY of this model.

    Raises
    ------
    PalpateError
        Packages for users are built without it.
    """
    try:
        harness = importlib.import_module(_HARNESS)
    except ImportError as error:
        raise PalpateError(
            "virtual time needs the servo that tests have: build it from Palpate's source with "
            "'make setup', or attack in real time, with --real"
        ) from error
    servo = harness.SteppedServo(
        body,
        settings,
        max_force=max_force,
        max_slew=max_slew,
        ramp_seconds=ramp_seconds,
        haply=haply,
    )
    return cast(SteppedServo, servo)
