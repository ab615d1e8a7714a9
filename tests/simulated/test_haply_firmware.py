"""The simulated hAPI board: every byte as the program on the board takes it."""

import struct

import pytest

from palpate.simulated.board.haply_firmware import PWM_STEPS, TORQUE_AT_FULL_DUTY, HaplyFirmware

ADDRESS = 5
SETUP = bytes([1, ADDRESS, 3, 1, 1, 3, 1, 1, 0, 0]) + struct.pack("<4f", 12, 4880, 168, 4880)


def torques(first, second, address=ADDRESS):
    return bytes([2, address]) + struct.pack("<2f", first, second)


class Board:
    def __init__(self):
        self.counts = [0, 0]
        self.firmware = HaplyFirmware(lambda: self.counts)
        self.now = 0.0

    def say(self, data, seconds=0.01):
        self.firmware.receive(data)
        self.now += seconds
        return self.firmware.run(self.now)

    @property
    def duties(self):
        return [port.duty for port in self.firmware.ports]


@pytest.fixture
def board():
    board = Board()
    assert board.say(b"\0\0" + SETUP) == b""
    return board


def test_angles_count_from_the_offsets_in_the_order_of_ports(board):
    answer = board.say(torques(0.0, 0.0))
    assert answer[0] == ADDRESS
    # Half of 4880 counts a turn, cut to whole ones: 81 and 1138.
    first, second = struct.unpack("<2f", answer[1:])
    assert (first, second) == pytest.approx((360 * 81 / 2440, 360 * 1138 / 2440), rel=1e-7)
    board.counts = [-10, 7]
    first, second = struct.unpack("<2f", board.say(torques(0.0, 0.0))[1:])
    assert (first, second) == pytest.approx((360 * 91 / 2440, 360 * 1131 / 2440), rel=1e-7)


def test_torques_become_duty_and_stay_for_ever(board):
    board.say(torques(0.05, -0.02))
    expected = [int(PWM_STEPS * torque / TORQUE_AT_FULL_DUTY) for torque in (0.05, 0.02)]
    assert board.duties == [-expected[0], expected[1]]
    assert board.say(b"", seconds=3600.0) == b""
    assert board.duties == [-expected[0], expected[1]]
    board.say(torques(9.0, float("nan")))
    assert board.duties == [-PWM_STEPS, 0]


def test_a_reset_forgets_the_ports_but_not_the_motors(board):
    board.say(torques(0.05, 0.05))
    before = board.duties
    board.say(b"\0\0")
    assert board.duties == before
    # Nothing of the next message finds a motor; its address comes back alone, floats are skipped.
    assert board.say(torques(0.01, 0.01)) == bytes([ADDRESS])
    assert board.duties == before


def test_an_unknown_address_is_answered_alone(board):
    assert board.say(bytes([2, 77])) == bytes([77])
    assert board.say(torques(0.0, 0.0))[0] == ADDRESS


def test_a_missing_byte_is_taken_from_the_next_message(board):
    whole = torques(0.05, 0.05)
    assert board.say(whole[:-1]) == b""
    assert len(board.say(whole)) == 9
    # The second float ended in the next message's command, 2: next to nothing.
    assert board.duties[1] == 0
    assert board.duties[0] != 0
    # What is left, an address and two floats, is skipped byte by byte, as none is a command.
    assert board.firmware.counters.bytes_skipped == 9
    assert len(board.say(whole)) == 9


def test_floats_are_waited_for_one_second_and_then_made_up(board):
    whole = torques(0.05, 0.05)
    board.say(whole)
    assert board.say(whole[:-3], seconds=0.9) == b""
    assert len(board.say(b"", seconds=0.2)) == 9
    assert board.firmware.counters.read_timeouts == 1


def test_hello_of_the_link_makes_it_forget_its_device(board):
    board.say(bytes([5, 1, 1, 0x1F, 0x3E, 0]), seconds=3.0)
    assert board.firmware.ports[0].motor_address != ADDRESS


def test_commands_are_50_microseconds_apart(board):
    board.firmware.receive(torques(0.0, 0.0) * 30)
    assert len(board.firmware.run(board.now + 0.001)) in range(18 * 9, 22 * 9)
