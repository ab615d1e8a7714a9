"""Protocol 1, a device that stops reading in the middle of a touch, behind a line that tells of no
queue, as a pseudo-terminal: what it finds there when it reads again, and that it ends in zero.
"""

import pytest

from palpate.core.servo import link
from palpate.simulated.attack.target import cube_target
from palpate.simulated.attack.virtual.virtual_press import VirtualPress

LINE_BYTES = 12 * 1024
"""What it holds without a word (docs/link.md)."""
FORCE_BYTES = 14
WATCHDOG_TICKS = 20
WAY_TICKS = 3
"""Of the device's FAULT to the host, and of the host's zero."""


class HoardingLine(VirtualPress):
    """Keeps what the device does not read; a mute device does not say either that nothing came."""

    def __init__(self, *, mute: bool) -> None:
        super().__init__(cube_target(), protocol=1)
        self.mute = mute
        self.reads = True
        self.hoard = b""

    def _taken(self, _seconds: float) -> int | None:
        return None if self.reads else LINE_BYTES - len(self.hoard)

    def _hear(self, sent: bytes) -> None:
        self.hoard += sent
        if self.reads:
            super()._hear(self.hoard)
            self.hoard = b""

    def _speak(self, now: float) -> bytes:
        if not self.mute:
            return super()._speak(now)
        said, self._answers = self._answers + self._state(now), b""
        return said

    def unread(self, milliseconds: int) -> list[link.Force]:
        """Read nothing for so long; FORCE that waits then."""
        self.reads = False
        for _ in range(milliseconds):
            self.tick()
        self.reads = True
        return [m for m in link.Decoder().feed(self.hoard) if isinstance(m, link.Force)]


def pushes(forces: list[link.Force]) -> list[bool]:
    return [bool(force.flags & link.ForceFlag.ENABLE) for force in forces]


def felt_again(line: HoardingLine) -> None:
    """The first reading makes no force; it comes back by the ramp alone."""
    first = line.tick()
    assert (first.felt, first.said.driving) == (0.0, 0)
    last = 0.0
    for shot in line.press():
        assert shot.felt <= last + 0.5 + 2e-3, shot
        last = shot.felt


@pytest.mark.parametrize("milliseconds", [25, 60, 300, 900, 1500, 3000])
def test_one_that_says_so_finds_the_force_of_its_watchdog_and_then_zero(milliseconds):
    line = HoardingLine(mute=False)
    line.press()
    told = pushes(line.unread(milliseconds))
    assert 0 < sum(told) <= WATCHDOG_TICKS + WAY_TICKS
    # All that push are before all that do not.
    assert told == sorted(told, reverse=True)
    assert not told[-1]
    felt_again(line)


@pytest.mark.parametrize("milliseconds", [900, 1500, 3000])
def test_one_that_is_mute_finds_what_the_line_holds_and_then_zero(milliseconds):
    line = HoardingLine(mute=True)
    line.press()
    told = pushes(line.unread(milliseconds))
    assert sum(told) <= LINE_BYTES / FORCE_BYTES
    felt_again(line)


@pytest.mark.parametrize("milliseconds", [5, 60, 300, 800])
def test_while_the_line_has_room_what_one_that_is_mute_obeys_is_new(milliseconds):
    line = HoardingLine(mute=True)
    line.press()
    forces = line.unread(milliseconds)
    assert len(forces) <= milliseconds
    # It obeys the newest of all that has come: of the last tick, or of this one.
    before, shot = line.servo.snapshot().output_force[2], line.tick()
    assert shot.felt == pytest.approx(before, abs=1e-3)
    assert shot.felt == pytest.approx(shot.output, abs=1e-3)
