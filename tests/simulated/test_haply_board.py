"""The simulated 2DIY behind its pseudo-terminal, with the clock in the test's hand."""

import math
import struct

import pytest
from terminals import HostEnd

from palpate.core.errors import PalpateError
from palpate.core.servo.haply_models import HAPLY_MODELS
from palpate.simulated.board.haply_board import HaplyBoard
from palpate.simulated.hand.options import SimulatedOptions

STEP = 1e-3
ADDRESS = 5


class Bench:
    """A board, a host's end of its port, and time that passes only when told to."""

    def __init__(self, name="2diy-3.1", **options):
        self.board = HaplyBoard(SimulatedOptions(**options), name)
        self.model = HAPLY_MODELS[name]
        self.ticks = 0
        self.host = HostEnd(self.board.port.path)

    def pass_time(self, seconds):
        for _ in range(round(seconds / STEP)):
            self.ticks += 1
            self.board.tick(self.ticks * STEP, 1)

    def say(self, data):
        self.host.say(data)
        self.pass_time(3 * STEP)
        return self.host.hear()

    def by_port(self, values):
        return [values[self.model.ports.index(port)] for port in (0, 1)]

    def set_up(self):
        model = self.model
        senses = self.by_port(model.motor_senses), self.by_port(model.encoder_senses)
        floats = [
            value
            for port in (0, 1)
            for value in (
                self.by_port(model.rest_degrees)[port],
                self.by_port(model.resolutions)[port],
            )
        ]
        head = bytes([1, ADDRESS, 3, *senses[0], 3, *senses[1], 0, 0])
        assert self.say(head + struct.pack("<4f", *floats)) == b""

    def ask(self, torques=(0.0, 0.0)):
        """Angles of arm 1 and 2, degrees, for torques of theirs."""
        answer = self.say(bytes([2, ADDRESS]) + struct.pack("<2f", *self.by_port(torques)))
        angles = struct.unpack("<2f", answer[1:])
        return [angles[port] for port in self.model.ports]

    def close(self):
        self.host.close()
        self.board.port.unplug()


@pytest.fixture
def bench():
    benches = []

    def start(**options):
        benches.append(Bench(**options))
        return benches[-1]

    yield start
    for one in benches:
        one.close()


@pytest.mark.parametrize("name", HAPLY_MODELS)
def test_angles_tell_where_the_handle_is(bench, name):
    one = bench(name=name)
    one.set_up()
    one.board.move_hand(one.ticks * STEP, (0.01, -0.005, 0.0), 0.2)
    one.pass_time(1.0)
    told = [math.radians(angle) for angle in one.ask()]
    seen = one.model.device_position(one.model.arm.handle(told))
    # Two counts, of the offset and of the encoder, on either arm of at most 0.3 mm each.
    assert math.dist(seen, one.board.report()["position"]) < 0.0012
    assert math.dist(one.board.report()["position"], (0.01, -0.005, 0.0)) < 1e-4


@pytest.mark.parametrize("name", HAPLY_MODELS)
def test_torques_push_the_handle_where_virtual_work_says(bench, name):
    one = bench(name=name)
    one.set_up()
    one.board.move_hand(one.ticks * STEP, (0.0, 0.0, 0.0), 0.2)
    one.pass_time(1.0)
    angles = tuple(math.radians(angle) for angle in one.board.report()["angles"])
    one.ask((0.02, -0.03))
    force = one.model.device_force(one.model.arm.handle_force(angles, (0.02, -0.03)))
    felt = one.board.report()["felt_force"]
    assert math.dist(felt, force) < 0.02 * math.hypot(*force)
    # The hand's spring of 500 N/m gives way by that.
    one.pass_time(1.0)
    pushed = one.board.report()["position"]
    report = one.board.report()
    assert math.dist(pushed, [f / 500.0 for f in report["felt_force"]]) < 1e-5


def test_nobody_ends_a_torque_but_the_plug(bench):
    one = bench()
    one.set_up()
    one.ask((0.05, 0.05))
    one.pass_time(5.0)
    assert max(map(abs, one.board.report()["torques"])) > 0.04
    one.board.unplug()
    assert one.board.report()["torques"] == [0.0, 0.0]
    one.board.plug_in()
    assert one.board.report()["plugged"]


def test_bytes_vanish_and_flip_as_told(bench):
    one = bench(loss=0.2, noise=0.01)
    one.say(bytes(1000))
    report = one.board.report()
    assert 120 < report["bytes_lost_on_purpose"] < 290
    assert 30 < report["bits_flipped_on_purpose"] < 120


def test_an_unknown_model_opens_no_port(tmp_path):
    with pytest.raises(PalpateError, match="no model"):
        HaplyBoard(SimulatedOptions(), "3diy")
    assert not (tmp_path / "port").exists()


def test_a_2diy_that_should_tell_an_orientation_is_refused(tmp_path):
    with pytest.raises(PalpateError, match="omit --turning"):
        HaplyBoard(SimulatedOptions(turning=10.0))
