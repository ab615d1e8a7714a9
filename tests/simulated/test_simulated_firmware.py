"""What the simulated device counts and tells of itself; for its rules see tests/firmware."""

import pytest

from palpate.core.servo import link
from palpate.simulated.board.simulated_firmware import Firmware

HELLO = link.DeviceHello("Test", 3, 2.0, (0.125, 0.125, 0.125), 1000)


@pytest.fixture
def greeted():
    firmware = Firmware(HELLO)
    tell(firmware, link.HostHello(), 0.0)
    return firmware


def tell(firmware, message, now):
    return link.Decoder().feed(firmware.receive(link.encode(message), now))


def force(sequence):
    return link.Force(sequence, (0, 0, 1000))


def test_sequence_and_clock_wrap(greeted):
    greeted._sequence = 65535
    first, second = link.Decoder().feed(
        greeted.state(4294.967295, (0, 0, 0), 0) + greeted.state(4294.967296, (0, 0, 0), 0)
    )
    assert (first.sequence, first.device_time_us) == (65535, 2**32 - 1)
    assert (second.sequence, second.device_time_us) == (0, 0)


def test_how_late_it_went_limp_is_counted(greeted):
    tell(greeted, force(0), 1.0)
    assert greeted.watch(1.0199) == b""
    assert greeted.watch(1.0201)
    assert greeted.counters.limp_count == 1
    assert greeted.counters.limp_after == pytest.approx(0.0201)
    assert greeted.counters.limp_look == pytest.approx(0.0002)


def test_a_board_that_looks_seldom_lets_go_before_the_twenty_milliseconds_are_over(greeted):
    tell(greeted, force(0), 1.0)
    assert greeted.watch(1.0189, 0.001) == b""
    assert greeted.watch(1.0191, 0.001)
    assert greeted.limp


def test_shortened_forces_are_counted_and_the_largest_is_kept(greeted):
    greeted.receive(link.encode(link.Force(0, (3000, 0, 4000))), 0.0)
    assert greeted.counters.clamped == 1
    assert greeted.counters.largest_force == pytest.approx(2.0)


def test_frames_of_the_other_direction_are_counted(greeted):
    tell(greeted, link.State(0, 0, (0, 0, 0)), 1.0)
    assert greeted.counters.unexpected == 1
