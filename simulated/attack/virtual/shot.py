"""One tick of a servo that is attacked, as user, line and motors see it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Said:
    """What was said to the device in a tick, counted by a codec that is not the servo's."""

    driving: int = 0
    """Forces, with the motors on."""
    released: int = 0
    """Motors off, and no force."""
    hollow: int = 0
    """Forces with the motors off: whoever looks at one of the two alone is misled."""


@dataclass(frozen=True)
class Shot:
    """One tick: what the servo says, wants and sends (N), and what the device's motors make (N)."""

    state: str
    fault: str
    reason: str
    limited: str
    wanted: float
    output: float
    change: float
    """Between this output and the one before, N."""
    felt: float
    felt_slew: float
    """By which the motors' force grew or turned since it was told last, N/s."""
    said: Said

    @property
    def name(self) -> str:
        """The fault, or the state with its reason."""
        return self.fault or (f"{self.state}: {self.reason}" if self.reason else self.state)

    @property
    def whole(self) -> bool:
        """The body is felt as it is."""
        return self.state == "touching" and not self.limited
