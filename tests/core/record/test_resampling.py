"""Recordings at an animation's rate, against closed forms."""

import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.record.recording import DTYPE
from palpate.core.record.resampling import frames_of, touched_part

RATE, FPS = 1000, 24
# Fast waves, and yet no finger that is set down elsewhere.
HEIGHT = 1e-3


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
    return lambda t: HEIGHT * np.sin(2 * np.pi * hertz * t)


def test_slow_motion_is_kept_and_faster_than_frames_is_not():
    slow = frames_of(ticks(2.0, wave(1.0)), 0, FPS)
    t = np.arange(len(slow.depth)) / FPS
    assert len(t) == 2 * FPS + 1
    np.testing.assert_allclose(slow.probe[3:-3, 2], -wave(1.0)(t)[3:-3], atol=0.006 * HEIGHT)
    np.testing.assert_allclose(slow.force[:, 0], -100 * slow.probe[:, 2], atol=1e-12)
    # At a third of the rate half the power, and at half of it less than half the height.
    for hertz, left in ((FPS / 3, np.sqrt(0.5)), (FPS / 2, 2.0 ** (-9 / 8))):
        shifted = ticks(2.0, lambda t, hertz=hertz: wave(hertz)(t + 0.25 / hertz))
        edge = frames_of(shifted, 0, FPS)
        assert np.abs(edge.probe[6:-6, 2]).max() == pytest.approx(left * HEIGHT, rel=0.01)


@pytest.mark.parametrize("hertz", [40.0, 47.9, 55.0, 250.0])
def test_a_tremble_leaves_no_slow_one(hertz):
    # Every 24th of a second a sine of 40 Hz looks like one of 8, of 47.9 like one of 0.1.
    t = np.arange(2 * FPS + 1) / FPS
    assert np.abs(wave(hertz)(t)).max() > 0.1 * HEIGHT
    fast = frames_of(ticks(2.0, wave(hertz)), 0, FPS)
    assert np.abs(fast.probe[6:-6, 2]).max() < 3e-4 * HEIGHT
    assert np.abs(fast.force[6:-6, 0]).max() < 3e-2 * HEIGHT


def test_a_tap_is_never_deeper_than_it_was():
    tap = frames_of(ticks(1.0, lambda t: np.where((t > 0.4) & (t < 0.6), 0.01, 0.0)), 0, FPS)
    assert tap.depth.max() <= 0.01 + 1e-12
    assert tap.depth.min() >= 0.0
    assert tap.depth.max() == pytest.approx(0.01, rel=0.01)


def test_a_tools_depth_is_what_was_measured_meanwhile():
    looks = np.array([[5.0, 0.0], [5.9, 0.0], [6.1, 0.004], [9.0, 0.004]])
    depth = frames_of(ticks(2.0, wave(1.0)), 0, FPS, looks).depth
    np.testing.assert_allclose(depth[: FPS - 6], 0.0, atol=1e-6)
    assert depth[FPS] == pytest.approx(0.002, rel=1e-3)
    np.testing.assert_allclose(depth[FPS + 6 :], 0.004, rtol=1e-3)


def test_missing_ticks_are_bridged_and_fingers_kept_apart():
    whole = ticks(1.0, lambda t: 0.01 * t)
    torn = np.delete(whole, slice(300, 500))
    both = np.concatenate([torn, ticks(1.0, lambda t: 0.02 * t, finger=1)])
    one, two = (frames_of(both, finger, FPS) for finger in (0, 1))
    np.testing.assert_allclose(one.depth, frames_of(whole, 0, FPS).depth, atol=1e-12)
    np.testing.assert_allclose(two.depth, 2 * one.depth, atol=1e-12)
    with pytest.raises(ValueError, match="finger 2"):
        frames_of(both, 2, FPS)


def test_a_computer_that_slept_leaves_a_second_of_rest():
    awake = ticks(2.0, lambda t: 0.01 * t)
    slept = awake.copy()
    slept["time"][1000:] += 8 * 3600.0
    frames = frames_of(slept, 0, FPS)
    assert len(frames.depth) == 3 * FPS + 1
    np.testing.assert_allclose(frames.depth[-6:], frames_of(awake, 0, FPS).depth[-6:], atol=1e-5)


def test_ticks_at_one_time_are_bridged_and_times_that_go_back_refused():
    pairs = ticks(1.0, lambda t: 0.01 * t)
    pairs["time"][1::2] = pairs["time"][:-1:2]
    assert frames_of(pairs, 0, FPS).depth[-1] == pytest.approx(0.01, rel=0.02)
    with pytest.raises(ValueError, match="go back"):
        frames_of(pairs[::-1], 0, FPS)


def test_more_frames_than_blender_numbers_are_refused():
    rare = ticks(60.0, lambda t: 0.01 * t)
    rare["time"] = np.arange(len(rare), dtype=float)
    with pytest.raises(PalpateError, match="frames that Blender numbers"):
        frames_of(rare, 0, FPS)


def test_a_finger_that_is_set_down_elsewhere_is_never_on_the_way_between():
    moved = ticks(1.0, lambda t: np.where(t < 0.51, 0.01, 0.0))
    moved["probe"][510:, 2] = -0.1
    heights = frames_of(moved, 0, FPS).probe[:, 2]
    np.testing.assert_allclose(heights[:13], -0.01, atol=1e-12)
    np.testing.assert_allclose(heights[13:], -0.1, atol=1e-12)


def test_idle_seconds_beside_the_touches_are_left_out():
    slow = ticks(
        9.0, lambda t: np.where((t > 3.0) & (t < 5.0), 0.01 * np.sin(np.pi * (t - 3.0)), 0)
    )
    times = touched_part(slow)["time"] - 5.0
    assert (times[0], times[-1]) == pytest.approx((2.5, 5.5), abs=0.01)
    # Laid on the surface it waits, too.
    slow["force"][1000:3000, 0] = 0.005
    assert touched_part(slow)["time"][0] - 5.0 == pytest.approx(2.5, abs=0.01)
    # Where it waited to be set down, no finger has been seen.
    slow["probe"][:2900, 2] = 0.1
    assert touched_part(slow)["time"][0] - 5.0 == pytest.approx(2.9, abs=0.002)
    slow["force"] = 0.0
    with pytest.raises(PalpateError, match="touched nothing"):
        touched_part(slow)
