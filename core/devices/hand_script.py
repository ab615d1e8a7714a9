"""Where the simulated hand wants to be: keyframes with minimum-jerk moves between them."""

from __future__ import annotations

import bisect
import csv
import io
import json
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from ..errors import PalpateError
from .plant import Vector


def minimum_jerk(s: float) -> float:
    """The smoothest way from 0 to 1: 10 s^3 - 15 s^4 + 6 s^5, at rest at both ends."""
    s = min(max(s, 0.0), 1.0)
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@dataclass(frozen=True)
class HandScript:
    """Keyframes: times in s, rising; positions in m. From `repeat_from` on it repeats for ever."""

    times: tuple[float, ...]
    positions: tuple[Vector, ...]
    repeat_from: float | None = None

    def __post_init__(self) -> None:
        if not self.times or len(self.times) != len(self.positions):
            raise PalpateError("the hand's script needs a position for every time, at least one")
        numbers = (*self.times, *(x for position in self.positions for x in position))
        if not all(map(math.isfinite, numbers)):
            raise PalpateError("the hand's script has a value that is no number; remove it")
        if any(later <= earlier for earlier, later in pairwise(self.times)):
            raise PalpateError("the hand's script has times that do not rise; sort its lines")
        if self.repeat_from is not None and not self.repeat_from < self.times[-1]:
            raise PalpateError("the hand's script repeats from after its end; take an earlier time")

    def at(self, time: float) -> Vector:
        """The target at `time`; before the first keyframe and after the last it stays there."""
        last = self.times[-1]
        if self.repeat_from is not None and time > last:
            time = self.repeat_from + (time - self.repeat_from) % (last - self.repeat_from)
        after = bisect.bisect_right(self.times, time)
        if after == 0 or after == len(self.times):
            return self.positions[0 if after == 0 else -1]
        begin, end = self.times[after - 1], self.times[after]
        s = minimum_jerk((time - begin) / (end - begin))
        a, b = self.positions[after - 1], self.positions[after]
        return (a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]))


def press_script(
    rest: Vector, at: Vector, by: Vector, *, approach: float, period: float, hold: float
) -> HandScript:
    """From `rest` to `at` in `approach` seconds, then press by `by` and come back, again and again.

    A press takes `period` seconds, of which the hand stays at the deepest point for `hold`; an
    infinite `hold` presses once and stays.
    """
    if not (approach > 0.0 and period > 0.0 and hold >= 0.0):
        raise PalpateError(
            "the hand's approach and period must be more than 0 s, hold at least 0 s"
        )
    deep = (at[0] + by[0], at[1] + by[1], at[2] + by[2])
    half = 0.5 * period
    if math.isinf(hold):
        return HandScript((0.0, approach, approach + half), (rest, at, deep))
    if hold >= period:
        raise PalpateError(f"the hand cannot hold {hold:g} s of a press of {period:g} s")
    way = 0.5 * (period - hold)
    times = [0.0, approach, approach + way, approach + way + hold, approach + period]
    positions = [rest, at, deep, deep, at]
    if hold == 0.0:
        del times[3], positions[3]
    return HandScript(tuple(times), tuple(positions), repeat_from=approach)


def read_script(path: Path) -> HandScript:
    """A script from a file: CSV lines `t,x,y,z` (s, m), or JSON.

    JSON: {"keyframes": [[t, x, y, z], ...], "repeat_from": seconds or null}.
    Raises PalpateError when the file cannot be read or understood.
    """
    try:
        text = path.read_text(encoding="utf-8")
        if text.lstrip().startswith("{"):
            content = json.loads(text)
            rows, repeat_from = content["keyframes"], content.get("repeat_from")
        else:
            rows = [row for row in csv.reader(io.StringIO(text)) if row and row[0].strip() != "t"]
            repeat_from = None
        times = tuple(float(t) for t, _, _, _ in rows)
        positions = tuple((float(x), float(y), float(z)) for _, x, y, z in rows)
        repeat = None if repeat_from is None else float(repeat_from)
    except OSError as error:
        raise PalpateError(f"{path}: {error.strerror}; give the path of a script") from error
    except (ValueError, KeyError, TypeError) as error:
        raise PalpateError(
            f"{path}: not a script of the hand ({error}); write CSV lines t,x,y,z "
            'or JSON {"keyframes": [[t, x, y, z], ...]}'
        ) from error
    return HandScript(times, positions, repeat)
