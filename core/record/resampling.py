"""Frames of an animation from ticks of the servo: low-pass first, then a value a frame."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..errors import PalpateError

Array = NDArray[np.float64]

# Standard deviation of a Gaussian, times its frequency of half power (-3 dB).
HALF_POWER = float(np.sqrt(np.log(2.0)) / (2.0 * np.pi))
# Where nothing was recorded for longer, s, the computer slept: the animation waits only so long.
LONGEST_GAP = 1.0
# As many as Blender numbers; and even ticks as a servo at 8 kHz counts in an hour.
MOST_FRAMES, MOST_TICKS = 1_048_574, 28_800_000
# Frequency of half power, over the frame rate. At half the rate, where aliases begin, 46 % of the
# amplitude are left, at the whole rate 4 %, at 5/3 of it (40 Hz at 24 frames a second) 2 in 10,000.
CUT_OFF = 1.0 / 3.0
# No hand moves a finger faster, m/s: it was set down elsewhere.
FASTEST = 4.0
# What is kept of the time before the first touch and after the last, s; and of the largest force,
# what is more than to be laid on the surface.
BESIDE_TOUCH = 0.5
FELT = 0.02


@dataclass(frozen=True, eq=False)
class Frames:
    """One finger's recording at an animation's rate, from the recording's first tick on.

    Attributes
    ----------
    probe : float64 (n, 3), metres, body coordinates.
    force : float64 (n, 3), the contact's force on the finger, newton, body axes.
    depth : float64 (n,), how deep the finger is in the body, metres.
    """

    probe: Array
    force: Array
    depth: Array


def frames_of(
    samples: NDArray[np.void],
    finger: int,
    frames_per_second: float,
    depths: Array | None = None,
) -> Frames:
    """Resample a finger's ticks, a structured array of ``recording.DTYPE``.

    A Gaussian that halves the power at a third of the frame rate goes first, as a hand trembles and
    a force jumps faster than frames can tell; it has no overshoot, so nothing is deeper or stronger
    than it was. A finger that was set down elsewhere is there in the next frame, never on the
    straight way between, which may go through the body. Ticks that are missing are bridged by
    straight lines, of a second at most. ``depths`` (k, 2), times of the samples, s, and metres, are
    a tool's; without them the depth is a point's, from probe to proxy.

    Raises
    ------
    ValueError
        The finger has no ticks, or times that go back.
    PalpateError
        More frames than Blender numbers.
    """
    own = samples[samples["finger"] == finger]
    if not len(own):
        message = f"finger {finger} has no ticks"
        raise ValueError(message)
    steps = np.diff(own["time"], prepend=own["time"][:1])
    if (steps < 0.0).any():
        message = f"finger {finger} has times that go back"
        raise ValueError(message)
    times = np.cumsum(np.minimum(steps, LONGEST_GAP))
    if times[-1] * frames_per_second > MOST_FRAMES:
        raise PalpateError(
            "recording: {seconds} s are more than the {most} frames that Blender numbers; record "
            "less, or take a lower frame rate",
            seconds=round(float(times[-1])),
            most=MOST_FRAMES,
        )
    step = max(_usual(steps), times[-1] / MOST_TICKS)
    starts = _set_down(own["probe"], np.maximum(steps, step))
    wanted = np.arange(0.0, times[-1] + 0.5 / frames_per_second, 1.0 / frames_per_second)
    spread = HALF_POWER / (CUT_OFF * frames_per_second) / step
    depth = (
        np.linalg.norm(own["probe"] - own["proxy"], axis=1)
        if depths is None
        else np.interp(own["time"], *depths.T)
    )

    def resampled(values: Array) -> Array:
        at = np.empty(len(wanted))
        for start, end in pairwise([*starts, len(times)]):
            even = np.arange(times[start], times[end - 1] + 0.5 * step, step)
            own_ticks = np.interp(even, times[start:end], values[start:end])
            smooth = gaussian_filter1d(own_ticks, spread, mode="nearest")
            until = times[end] if end < len(times) else np.inf
            shown = slice(*np.searchsorted(wanted, [times[start], until]))
            at[shown] = np.interp(wanted[shown], even, smooth)
        return at

    def each(vectors: Array) -> Array:
        return np.column_stack([resampled(vectors[:, axis]) for axis in range(3)])

    return Frames(each(own["probe"]), each(own["force"]), resampled(depth))


def touched_part(samples: NDArray[np.void]) -> NDArray[np.void]:
    """Ticks of all fingers from half a second before the first touch to half a second after the
    last; before the first no finger is where it had not been set down yet.

    Raises
    ------
    PalpateError
        Nothing was touched.
    """
    strength = np.linalg.norm(samples["force"], axis=1)
    touching = samples["time"][strength > FELT * strength.max(initial=0.0)]
    if not len(touching):
        raise PalpateError(
            "recording: the finger touched nothing; press while it records, and take that"
        )
    begun = touching[0] - BESIDE_TOUCH
    for finger in np.unique(samples["finger"]):
        own = samples[samples["finger"] == finger]
        before = own[own["time"] <= touching[0]]
        if len(before):
            steps = np.diff(before["time"], prepend=before["time"][:1])
            last = _set_down(before["probe"], np.maximum(steps, _usual(steps)))[-1]
            begun = max(begun, before["time"][last])
    times = samples["time"]
    kept: NDArray[np.void] = samples[(times >= begun) & (times <= touching[-1] + BESIDE_TOUCH)]
    return kept


def _usual(steps: Array) -> float:
    """Usual time from tick to tick, s; 1 where there is none."""
    went = steps[steps > 0.0]
    return float(np.median(went)) if len(went) else 1.0


def _set_down(probe: Array, steps: Array) -> list[int]:
    """Ticks from which on a finger is where it was set down, the first among them."""
    way = np.linalg.norm(np.diff(probe, axis=0), axis=1)
    return [0, *(np.flatnonzero(way > FASTEST * steps[1:]) + 1).tolist()]
