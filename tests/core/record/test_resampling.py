"""Recordings at an animation's rate, against closed forms."""

import numpy as np
import pytest

from palpate.core.record.recording import DTYPE
from palpate.core.record.resampling import frames_of

RATE, FPS = 1000, 24


def ticks(seconds, place, finger=0):
    """Samples at 1 kHz whose probe, proxy and force follow ``place(t)``, (n,)."""
    samples = np.zeros(int(seconds * RATE) + 1, DTYPE)
    samples["time"] = 5.0 + np.arange(len(samples)) / RATE
    samples["finger"] = finger
    way = place(samples["time"] - 5.0)
    samples["probe"][:, 2] = -way
    samples["force"][:, 0] = 100 * way
    return samples


def wave(hertz):
    return lambda t: np.sin(2 * np.pi * hertz * t)


def test_slow_motion_is_kept_and_faster_than_frames_is_not():
    slow = frames_of(ticks(2.0, wave(1.0)), 0, FPS)
    t = np.arange(len(slow.depth)) / FPS
    assert len(t) == 2 * FPS + 1
    np.testing.assert_allclose(slow.probe[2:-2, 2], -wave(1.0)(t)[2:-2], atol=0.005)
    np.testing.assert_allclose(slow.force[:, 0], -100 * slow.probe[:, 2], atol=1e-12)
    # At the highest frequency that frames can tell, half the power; 60 Hz would be seen as 12.
    edge = frames_of(ticks(2.0, lambda t: np.cos(np.pi * FPS * t)), 0, FPS)
    assert np.abs(edge.probe[4:-4, 2]).max() == pytest.approx(np.sqrt(0.5), abs=0.002)
    fast = frames_of(ticks(2.0, wave(60.0)), 0, FPS)
    assert np.abs(fast.probe[4:-4, 2]).max() < 1e-3


def test_a_tap_is_never_deeper_than_it_was():
    tap = frames_of(ticks(1.0, lambda t: np.where((t > 0.4) & (t < 0.6), 0.01, 0.0)), 0, FPS)
    assert tap.depth.max() <= 0.01 + 1e-12
    assert tap.depth.min() >= 0.0
    assert tap.depth.max() == pytest.approx(0.01, rel=0.01)


def test_missing_ticks_are_bridged_and_fingers_kept_apart():
    whole = ticks(1.0, lambda t: 0.01 * t)
    torn = np.delete(whole, slice(300, 500))
    both = np.concatenate([torn, ticks(1.0, lambda t: 0.02 * t, finger=1)])
    one, two = (frames_of(both, finger, FPS) for finger in (0, 1))
    np.testing.assert_allclose(one.depth, frames_of(whole, 0, FPS).depth, atol=1e-12)
    np.testing.assert_allclose(two.depth, 2 * one.depth, atol=1e-12)
    with pytest.raises(ValueError, match="finger 2"):
        frames_of(both, 2, FPS)
