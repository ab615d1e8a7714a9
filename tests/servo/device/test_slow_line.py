"""Lines of any speed: no force waits behind another, and what comes too late is not felt."""

import pytest
from slow_press import STEP, TICK, press

BAUDS = [9_600, 19_200, 57_600, 115_200, 250_000, 1_000_000]
SLOW, FAST = 115_200, 1_000_000
LINES = [
    (SLOW, 1000),
    (FAST, 100),
    *(
        pytest.param(*line, marks=pytest.mark.at_length)
        for line in ((SLOW, 100), (SLOW, 400), (FAST, 400), (FAST, 1000))
    ),
]


@pytest.mark.parametrize("protocol", [1, 2])
@pytest.mark.parametrize("rate_hz", [100, 400, 1000])
@pytest.mark.parametrize("baud", BAUDS)
def test_a_force_waits_for_at_most_a_tick(baud, rate_hz, protocol):
    found = press(baud, rate_hz, protocol, seconds=1.5)
    assert found.oldest_push <= TICK + STEP
    # 20 ms are too little for the slowest: no force rather than an old one.
    too_slow = baud < 57_600 if protocol == 2 else baud < 19_200
    assert (found.largest > 0.5) is not too_slow, found
    assert bool(found.seen & {"stale", "deaf"}) is too_slow


@pytest.mark.parametrize(("baud", "rate_hz"), LINES)
def test_a_device_that_reads_nothing_for_three_seconds_is_handed_no_old_force(baud, rate_hz):
    found = press(baud, rate_hz, seconds=5.5, reads_not=(1.5, 4.5))
    # Since the first FORCE that was not taken, in answer to the next STATE.
    assert found.deaf_after <= 0.02 + 1 / rate_hz + 2 * TICK
    assert found.queued_pushes <= 4
    assert found.largest > 0.5
    assert found.largest_in_silence == 0.0


@pytest.mark.parametrize(("baud", "rate_hz"), LINES)
def test_an_older_device_says_that_it_heard_nothing_and_zero_is_the_last_that_waits(baud, rate_hz):
    found = press(baud, rate_hz, 1, seconds=5.5, reads_not=(1.5, 4.5))
    # Its watchdog, the way of its FAULT behind a STATE, and a tick.
    assert found.deaf_after <= 0.02 + 40 * 10 / baud + 3 * TICK
    # What the watchdog's time brings.
    assert found.queued_pushes <= 1 + (0.02 + 40 * 10 / baud + 3 * TICK) * min(rate_hz, 1000)
    assert not found.last_pushes
    assert found.newest_push_in_silence <= 1.5 + found.deaf_after + TICK
    assert found.largest > 0.5
    assert found.largest_at_the_end > 0.5
