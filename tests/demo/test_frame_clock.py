"""Frames of the demo keep their rate, and go on until there is something to show."""

import itertools

import pytest
from frame_clock import FRAME_RATE, PATIENCE, frames


class Clock:
    """Time that passes by waiting; `sleep` refuses what no system can wait for."""

    def __init__(self):
        self.now = 100.0

    def perf_counter(self):
        return self.now

    def sleep(self, seconds):
        assert seconds >= 0.0
        self.now += seconds


def test_frames_come_at_their_rate_for_as_long_as_asked():
    clock = Clock()
    begun = list(frames(2.0, lambda: True, clock))
    assert len(begun) == pytest.approx(2 * FRAME_RATE, abs=1)
    steps = [after - before for before, after in itertools.pairwise(begun)]
    assert steps == pytest.approx([1 / FRAME_RATE] * len(steps))


def test_a_frame_that_took_too_long_is_not_made_up_for():
    clock, begun = Clock(), []
    for number, at in enumerate(frames(2.0, lambda: True, clock)):
        begun.append(at)
        clock.now += 0.5 if number == 3 else 0.0
    late = begun[4] - begun[3]
    assert late == pytest.approx(0.5)
    assert begun[5] - begun[4] == pytest.approx(1 / FRAME_RATE)


@pytest.mark.parametrize("seconds_until_it_comes", [1.0, 3.0, 1e9])
def test_what_has_not_come_is_waited_for_but_not_for_ever(seconds_until_it_comes):
    clock = Clock()
    *_, last = frames(2.0, lambda: clock.now - 100.0 >= seconds_until_it_comes, clock)
    taken = last + 1 / FRAME_RATE - 100.0
    expected = min(max(seconds_until_it_comes, 2.0), 2.0 * PATIENCE)
    assert taken == pytest.approx(expected, abs=2 / FRAME_RATE)
