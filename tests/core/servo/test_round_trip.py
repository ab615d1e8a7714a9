"""Round trip of a line: from a zero force to the STATE that names it."""

import pytest

from palpate.core.servo import link
from palpate.core.servo.round_trip import RoundTrip
from palpate.simulated.board.simulated_firmware import Firmware

EXTENTS = (0.1, 0.1, 0.1)


def device(protocol):
    firmware = Firmware(link.DeviceHello("Test", 3, 1.0, EXTENTS, 1000, protocol))
    firmware.receive(link.encode(link.HostHello(protocol)), 0.0)
    return firmware


@pytest.mark.parametrize("lag", [1, 7, 30])
def test_it_is_the_time_there_and_back_whatever_that_is(lag):
    firmware, trip, on_its_way = device(2), RoundTrip(), []
    for tick in range(1, 500):
        now = tick * 1e-3
        (state,) = link.Decoder().feed(firmware.state(now, (0, 0, 0), 0))
        on_its_way.append(trip.answer(state, now))
        if len(on_its_way) >= lag:
            firmware.receive(on_its_way.pop(0), now)
    # Zero is taken however late it comes.
    assert firmware.counters.forces > 400
    assert trip.milliseconds == pytest.approx(lag, abs=1e-6)


def test_in_protocol_1_nothing_is_said_and_nothing_known():
    firmware, trip = device(1), RoundTrip()
    (state,) = link.Decoder().feed(firmware.state(0.0, (0, 0, 0), 0))
    assert trip.answer(state, 0.0) == b""
    assert trip.milliseconds is None
