"""The rules of the device's side of the link, with a clock in the test's hand."""

import pytest

from palpate.core.servo import link
from palpate.simulated.board.simulated_firmware import FAULT_LIMP, FAULT_PROTOCOL, Firmware
from palpate.simulated.hand.plant import ZERO

HELLO = link.DeviceHello("Test", 3, 2.0, (0.125, 0.125, 0.125), 1000)


@pytest.fixture
def firmware():
    return Firmware(HELLO)


@pytest.fixture
def greeted(firmware):
    tell(firmware, link.HostHello(), 0.0)
    return firmware


def tell(firmware, message, now):
    return link.Decoder().feed(firmware.receive(link.encode(message), now))


def force(sequence, z_mn=1000, flags=link.ForceFlag.ENABLE):
    return link.Force(sequence, (0, 0, z_mn), flags)


def test_nothing_is_said_before_hello(firmware):
    assert firmware.state(0.0, (0, 0, 0), 0) == b""
    tell(firmware, force(0), 0.0)
    assert firmware.limp
    assert firmware.counters.unexpected == 1


def test_hello_is_answered_every_time_and_starts_the_stream(firmware):
    assert tell(firmware, link.HostHello(), 0.0) == [HELLO]
    assert tell(firmware, link.HostHello(), 0.1) == [HELLO]
    states = link.Decoder().feed(
        firmware.state(0.25, (1, -2, 3), 1) + firmware.state(0.5, (4, 5, 6), 0)
    )
    assert states == [
        link.State(0, 250_000, (1, -2, 3), 1, link.StateFlag.READY),
        link.State(1, 500_000, (4, 5, 6), 0, link.StateFlag.READY),
    ]


def test_an_orientation_bears_the_number_of_the_state_to_come(firmware):
    assert firmware.orientation((1.0, 0.0, 0.0, 0.0)) == b""
    tell(firmware, link.HostHello(), 0.0)
    for sequence in range(3):
        said = firmware.orientation((0.0, 0.6, 0.0, -0.8)) + firmware.state(0.0, (0, 0, 0), 0)
        orientation, state = link.Decoder().feed(said)
        assert orientation == link.Orientation(sequence, (0, 19660, 0, -26214))
        assert state.sequence == sequence


def test_another_protocol_is_answered_with_hello_and_fault_but_no_stream(firmware):
    assert tell(firmware, link.HostHello(9), 0.0) == [HELLO, link.Fault(FAULT_PROTOCOL, 9)]
    assert firmware.state(0.0, (0, 0, 0), 0) == b""


def test_another_protocol_in_between_ends_stream_and_force_until_it_is_greeted_again(greeted):
    tell(greeted, force(0), 1.0)
    assert greeted.force == (0.0, 0.0, 1.0)
    assert tell(greeted, link.HostHello(7), 1.001) == [HELLO, link.Fault(FAULT_PROTOCOL, 7)]
    assert (greeted.force, greeted.state(1.002, (0, 0, 0), 0)) == (ZERO, b"")
    tell(greeted, force(1), 1.003)
    assert (greeted.force, greeted.watch(1.1)) == (ZERO, b"")
    tell(greeted, link.HostHello(), 2.0)
    assert greeted.state(2.001, (0, 0, 0), 0)


def test_sequence_and_clock_wrap(greeted):
    greeted._sequence = 65535
    first, second = link.Decoder().feed(
        greeted.state(4294.967295, (0, 0, 0), 0) + greeted.state(4294.967296, (0, 0, 0), 0)
    )
    assert (first.sequence, first.device_time_us) == (65535, 2**32 - 1)
    assert (second.sequence, second.device_time_us) == (0, 0)


def test_force_acts_only_when_enabled(greeted):
    tell(greeted, force(0), 0.0)
    assert greeted.force == (0.0, 0.0, 1.0)
    tell(greeted, force(1, flags=0), 0.001)
    assert greeted.force == ZERO
    assert not greeted.limp


def test_damping_is_asked_for_with_or_without_motors(greeted):
    tell(greeted, force(0, flags=link.ForceFlag.DAMP), 0.0)
    assert greeted.braked
    assert greeted.force == ZERO
    tell(greeted, force(1), 0.001)
    assert not greeted.braked


def test_twenty_milliseconds_of_silence_make_the_device_limp_and_it_says_so_once(greeted):
    tell(greeted, force(0, flags=link.ForceFlag.ENABLE | link.ForceFlag.DAMP), 1.0)
    assert greeted.watch(1.0199) == b""
    assert greeted.force == (0.0, 0.0, 1.0)
    assert link.Decoder().feed(greeted.watch(1.0201)) == [link.Fault(FAULT_LIMP, 1)]
    assert (greeted.force, greeted.braked, greeted.limp) == (ZERO, False, True)
    assert greeted.watch(1.03) == b""
    assert greeted.counters.limp == 1
    assert greeted.counters.limp_after == pytest.approx(0.0201)
    assert greeted.counters.limp_look == pytest.approx(0.0002)


def test_a_board_that_looks_seldom_lets_go_before_the_twenty_milliseconds_are_over(greeted):
    tell(greeted, force(0), 1.0)
    assert greeted.watch(1.0189, 0.001) == b""
    assert greeted.watch(1.0191, 0.001)
    assert greeted.limp


def test_a_limp_device_takes_up_again_at_any_sequence(greeted):
    tell(greeted, force(500), 1.0)
    greeted.watch(2.0)
    tell(greeted, force(3), 2.0)
    assert greeted.force == (0.0, 0.0, 1.0)
    assert greeted.counters.lost == 0


def test_damaged_forces_do_not_keep_the_device_going(greeted):
    tell(greeted, force(0), 1.0)
    damaged = bytearray(link.encode(force(1)))
    damaged[1] ^= 0x40
    greeted.receive(bytes(damaged), 1.015)
    greeted.watch(1.021)
    assert greeted.limp
    assert greeted.decoder.errors.crc_errors == 1


def test_repeated_and_late_forces_are_counted_and_do_not_keep_it_going(greeted):
    tell(greeted, force(10, 500), 1.0)
    tell(greeted, force(10, 900), 1.015)
    tell(greeted, force(9, 900), 1.016)
    assert greeted.force == (0.0, 0.0, 0.5)
    assert (greeted.counters.duplicates, greeted.counters.out_of_order) == (1, 1)
    greeted.watch(1.021)
    assert greeted.limp


def test_half_the_sequences_ahead_is_late_and_one_less_is_not(greeted):
    tell(greeted, force(65_000), 1.0)
    tell(greeted, force((65_000 + 0x8000) % 2**16, 900), 1.0)
    assert greeted.counters.out_of_order == 1
    tell(greeted, force((65_000 + 0x7FFF) % 2**16, 750), 1.0)
    assert greeted.force == (0.0, 0.0, 0.75)
    assert (greeted.counters.lost, greeted.counters.out_of_order) == (0x7FFE, 1)


def test_gaps_are_counted_also_where_the_sequence_wraps(greeted):
    for sequence in (65533, 65534, 1, 2, 5):
        tell(greeted, force(sequence), 1.0)
    assert greeted.counters.lost == 2 + 2
    assert greeted.counters.forces == 5


def test_more_than_the_largest_force_is_shortened(greeted):
    greeted.receive(link.encode(link.Force(0, (3000, 0, 4000))), 0.0)
    assert greeted.force == pytest.approx((1.2, 0.0, 1.6))
    assert greeted.counters.clamped == 1
    assert greeted.counters.largest_force == pytest.approx(2.0)


def test_hello_in_between_ends_the_old_session(greeted):
    tell(greeted, force(10), 1.0)
    tell(greeted, link.HostHello(), 1.001)
    assert greeted.force == ZERO
    tell(greeted, force(0), 1.002)
    assert greeted.force == (0.0, 0.0, 1.0)


def test_plugged_in_again_the_board_waits_for_hello(greeted):
    tell(greeted, force(0), 1.0)
    greeted.receive(b"half a frame", 1.0)
    greeted.plug_in()
    assert greeted.limp
    assert greeted.state(2.0, (0, 0, 0), 0) == b""
    assert tell(greeted, link.HostHello(), 2.0) == [HELLO]


def test_frames_of_the_other_direction_are_counted(greeted):
    tell(greeted, link.State(0, 0, (0, 0, 0)), 1.0)
    assert greeted.counters.unexpected == 1
