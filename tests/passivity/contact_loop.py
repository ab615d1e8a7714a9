"""A device and a hand that press a body, in the loop with the servo's own coupling and limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

import palpate_servo
from palpate_servo import harness


@dataclass(frozen=True)
class DevicePlant:
    """What moves in a device, and its electronics. SI units; a step of 0 is none.

    Attributes
    ----------
    mass, damping, coulomb : moving mass (kg), viscous friction (N s/m), Coulomb friction (N).
    encoder_step, force_step : m, N.
    delay, jitter : s between reading and obeying besides the holding of a tick, and what is random
        about it.
    rate_hz : of the servo.
    """

    mass: float
    damping: float
    coulomb: float = 0.0
    encoder_step: float = 0.0
    force_step: float = 0.0
    delay: float = 0.0
    jitter: float = 0.0
    rate_hz: int = 1000


@dataclass(frozen=True)
class PassiveHand:
    """A spring (N/m) and a damper (N s/m) to a place that rests, and a constant push (N)."""

    stiffness: float = 0.0
    damping: float = 0.0
    push: float = 0.0
    target: float = 0.0
    """Where the spring would be at rest, m into the body."""

    @classmethod
    def gripping(
        cls, stiffness: float, relaxation: float, force: float, seen_stiffness: float
    ) -> PassiveHand:
        """A hand that comes to rest with `force` (N) on a body of `seen_stiffness` (N/m).

        relaxation : its damping over its stiffness, s.
        """
        reach = force / seen_stiffness + force / stiffness
        return cls(stiffness, stiffness * relaxation, target=reach)


@dataclass(frozen=True)
class CouplingSettings:
    """What `Coupling` of the servo's settings takes."""

    stiffness: float = math.inf
    damping: float = 0.0
    passivity_control: bool = False

    @classmethod
    def for_devices(cls, rate_hz: int = 1000, encoder_step: float = 0.0) -> CouplingSettings:
        """The servo's default for devices with motors and encoders of such a step (m)."""
        return cls(**palpate_servo.device_coupling(rate_hz, encoder_step=encoder_step))

    def seen_stiffness(self, body_stiffness: float) -> float:
        """What a device at rest sees of a body, N/m."""
        return min(body_stiffness, self.stiffness)


NONE = CouplingSettings()
"""The body itself."""


@dataclass(frozen=True)
class Press:
    """How the touch begins: where (m into the body), how fast (m/s), and how long it is watched."""

    start: float = -1e-4
    speed: float = 0.1
    seconds: float = 2.0
    max_force: float = 3.0
    max_slew: float = 1000.0
    seed: int = 1


def press(
    plant: DevicePlant,
    hand: PassiveHand,
    body_stiffness: float,
    coupling: CouplingSettings = NONE,
    how: Press | None = None,
    *,
    trace: bool = False,
) -> palpate_servo.ContactOutcome:
    """Run the loop; see `palpate_servo.harness.simulate_contact`, which raises ValueError."""
    how = Press() if how is None else how
    return harness.simulate_contact(
        plant,
        hand,
        how,
        coupling,
        rate_hz=plant.rate_hz,
        body_stiffness=body_stiffness,
        trace=trace,
    )
