"""Recording of a press: every tick of the force loop, kept in memory until the next one.

The servo's thread collects the ticks, so that none is missing however busy Blender is.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.record.recording import DTYPE, write_recording
from ...core.servo.session import STATES, Servo
from ..scene.object_handle import ObjectHandle

BYTES_A_TICK = DTYPE.itemsize


@dataclass(frozen=True, eq=False)
class Kept:
    """Recorded ticks of an ended press, structured array (n,) of ``DTYPE``, and the object that was
    pressed; None where nobody says. Places and forces are those in the body's axes, or ``in_world``
    of one that nobody held. ``depths`` (k, 1 + fingers), times, s, and metres, tell how deep a tool
    was whenever the view looked; None of a point.
    """

    samples: NDArray[np.void]
    rate_hz: int
    lost: int = 0
    pressed: ObjectHandle | None = None
    in_world: bool = False
    depths: NDArray[np.float64] | None = None


@dataclass(eq=False)
class Recorder:
    """Recorder of a press.

    ``seconds`` is the length so far; ``full`` once the limit is reached.
    """

    servo: Servo
    rate_hz: int
    pressed: ObjectHandle | None = None
    in_world: bool = False
    wanted: bool = False
    full: bool = False
    seconds: float = 0.0
    lost: int = 0
    _depths: list[tuple[float, ...]] = field(default_factory=list)
    _longest: float = 0.0
    _begun_at: float = 0.0
    _stopped: bool = False

    def start(self, longest: float, now: float) -> None:
        """Start a new recording; ``now`` is the servo's time, s.

        Raises
        ------
        PalpateError
            The servo refuses.
        """
        try:
            self.servo.start_recording(longest)
        except (ValueError, RuntimeError, MemoryError) as problem:
            raise PalpateError(
                "recording: {problem}; set fewer Minutes, or stop the one going on",
                problem=problem,
            ) from problem
        self.wanted, self.full, self.seconds, self.lost = True, False, 0.0, 0
        self._longest, self._begun_at, self._stopped = longest, now, False
        self._depths.clear()

    def stop(self) -> None:
        """Stop recording and keep it."""
        self.servo.stop_recording()
        self._stopped = True

    def follow(self, now: float) -> None:
        """Update the length of the recording."""
        if not self.wanted or self.full or self._stopped:
            return
        self.lost = self.servo.recording_lost
        self.seconds = min(now - self._begun_at, self._longest)
        # The limit is reached.
        self.full = not self.servo.is_recording

    def note_depths(self, now: float, depths: Iterable[float]) -> None:
        """Keep how deep the tools are, metres, which no tick tells: it takes the rest surface."""
        if self.going_on:
            self._depths.append((now, *depths))

    @property
    def going_on(self) -> bool:
        """Whether a recording is running."""
        return self.wanted and self.servo.is_recording

    def kept(self) -> Kept:
        """All ticks so far, a copy."""
        lost = self.servo.recording_lost
        ticks, depths = self.servo.recording(), np.array(self._depths) if self._depths else None
        return Kept(ticks, self.rate_hz, lost, self.pressed, self.in_world, depths)


_last: Kept | None = None


def last() -> Kept | None:
    """Latest recording of an ended press."""
    return _last


def keep(recorder: Recorder | None) -> None:
    """Keep the recording of a press that is about to end, if there is one."""
    global _last  # noqa: PLW0603  one recording is kept, as there is one press at a time
    if recorder is not None and recorder.wanted:
        _last = recorder.kept()


def write(path: Path, kept: Kept) -> None:
    """Write a recording as CSV or npz, by the suffix.

    Raises
    ------
    PalpateError
        The path cannot be written, or has another suffix.
    """
    write_recording(path, kept.samples, STATES, kept.rate_hz)
