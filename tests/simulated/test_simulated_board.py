"""The simulated device behind its pseudo-terminal, with the clock in the test's hand."""

from itertools import pairwise

import pytest
from terminals import HostEnd

from palpate.core.errors import PalpateError
from palpate.core.servo import link
from palpate.simulated.board.simulated_board import SimulatedBoard
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.wire.ports import ANY_SOCKET, HAS_PSEUDO_TERMINALS, device_port

STEP = 1e-3


class Bench:
    """A board, a host's end of its port, and time that passes only when told to."""

    def __init__(self, path, **options):
        self.board = SimulatedBoard(SimulatedOptions(link=path, **options))
        self.ticks = 0
        self.decoder = link.Decoder()
        self.host = None
        self.open()

    def open(self):
        self.close()
        self.host = HostEnd(self.board.port.path)

    def close(self):
        if self.host:
            self.host.close()
        self.host = None

    def say(self, message):
        self.host.say(link.encode(message))

    def pass_time(self, seconds):
        """Returns all that the device has said meanwhile."""
        heard = []
        for _ in range(round(seconds / STEP)):
            self.ticks += 1
            self.board.tick(self.ticks * STEP, 1)
            if self.host:
                heard += self.decoder.feed(self.host.hear())
        return heard

    def greet(self):
        self.say(link.HostHello())
        return self.pass_time(STEP)


@pytest.fixture(params=["terminal", "socket"])
def path(request, tmp_path):
    if request.param == "socket":
        return ANY_SOCKET
    if not HAS_PSEUDO_TERMINALS:
        pytest.skip("about terminals, which Windows does not have")
    return str(tmp_path / "port")


@pytest.fixture
def bench(path):
    benches = []

    def make(**options):
        benches.append(Bench(path, **options))
        return benches[-1]

    yield make
    for one in benches:
        one.close()
        one.board.port.unplug()


def states(heard):
    return [message for message in heard if isinstance(message, link.State)]


def test_hello_starts_one_state_a_tick_without_gaps(bench):
    device = bench()
    assert device.pass_time(0.01) == []
    hello, first = device.greet()
    assert (hello.name, hello.rate_hz) == ("Simulated", 1000)
    heard = [first, *device.pass_time(0.1)]
    assert [state.sequence for state in heard] == list(range(101))
    assert {b.device_time_us - a.device_time_us for a, b in pairwise(heard)} == {1000}


def test_without_turning_no_orientation_is_told_and_with_it_one_before_each_state(bench):
    device = bench()
    device.greet()
    assert {type(message) for message in device.pass_time(0.05)} == {link.State}
    device.board.turn_hand(device.ticks * STEP, (0.0, 0.0, 0.0, 1.0), 0.02)
    heard = device.pass_time(0.05)
    assert [type(message) for message in heard] == [link.Orientation, link.State] * 50
    turns, places = heard[::2], heard[1::2]
    assert [turn.sequence for turn in turns] == [place.sequence for place in places]
    assert turns[-1].quaternion == (0, 0, 0, 32767)
    steps = [turn.quaternion[3] for turn in turns]
    assert steps == sorted(steps)
    assert steps[0] < 500


def test_the_stylus_is_tilted_from_the_first_host_on(bench):
    device = bench(turning=90.0, turning_axis=(0.0, 0.0, 1.0), turning_period=1.0)
    device.pass_time(0.3)
    _hello, first, state = device.greet()
    assert (first.sequence, state.sequence) == (0, 0)
    assert first.quaternion == pytest.approx((32767, 0, 0, 0), abs=1)
    heard = [m for m in device.pass_time(0.5) if isinstance(m, link.Orientation)]
    assert heard[-1].quaternion == pytest.approx((23170, 0, 0, 23170), abs=2)


def test_a_script_and_an_option_cannot_both_turn_the_stylus(bench, tmp_path):
    script = tmp_path / "turning.csv"
    script.write_text("0,0,0,0,0,1,0,0\n")
    device = bench(script=str(script))
    assert device.greet()[1].quaternion == (0, 32767, 0, 0)
    with pytest.raises(PalpateError, match="omit --turning"):
        SimulatedBoard(SimulatedOptions(script=str(script), turning=10.0))


def test_the_hand_waits_for_hello_and_then_follows_its_script(bench):
    device = bench(
        rest=(0.0, 0.0, 0.05), at=(0.0, 0.0, 0.03), by=(0.001, 0.0, -0.01), approach=0.5, period=1.0
    )
    device.pass_time(2.0)
    assert device.board.plant.position == pytest.approx((0.0, 0.0, 0.05))
    device.greet()
    device.pass_time(0.999)
    assert device.board.plant.target == pytest.approx((0.001, 0.0, 0.02))
    (last,) = states(device.pass_time(STEP))
    # The hand leads the device by what its friction and mass take.
    assert last.position_um == pytest.approx((1000, 0, 20000), abs=200)
    device.pass_time(0.5)
    report = device.board.report()
    assert report["position_max"][2] == pytest.approx(0.05)
    assert report["position_min"][2] == pytest.approx(0.02, abs=2e-4)


def test_positions_come_in_steps_of_the_encoder(bench):
    device = bench(resolution_um=50, rest=(0.0, 0.0, 0.0), by=(0.003, 0.0, -0.004), approach=0.01)
    device.greet()
    seen = {axis for state in states(device.pass_time(1.0)) for axis in state.position_um}
    assert all(axis % 50 == 0 for axis in seen)
    assert len(seen) > 50


def test_a_constant_force_moves_the_hand_by_force_over_stiffness(bench):
    device = bench(rest=(0.0, 0.0, 0.03), hand_stiffness=400.0)
    device.greet()
    for sequence in range(1000):
        device.say(link.Force(sequence, (0, -1000, 2000)))
        heard = device.pass_time(STEP)
    assert states(heard)[-1].position_um == (0, -2500, 35000)
    report = device.board.report()
    assert report["hand_force"] == pytest.approx((0.0, 1.0, -2.0), abs=1e-6)
    # F . F / k: half of it is in the spring, half went into the dampers.
    assert report["work_of_felt_force"] == pytest.approx((1.0 + 4.0) / 400.0, rel=1e-6)


def test_forces_come_in_steps_of_the_motor_and_coulomb_friction_holds_below_its_own(bench):
    device = bench(rest=(0.0, 0.0, 0.0), force_step=0.25, coulomb=0.3, hand_stiffness=500.0)
    device.greet()
    for sequence in range(500):
        device.say(link.Force(sequence, (374, 376, -120)))
        device.pass_time(STEP)
    report = device.board.report()
    # 0.25 N is less than the friction; 0.5 N moves it to where friction and spring hold it.
    assert report["position"][0] == 0.0
    assert 0.2 / 500.0 - 1e-9 <= report["position"][1] <= 0.8 / 500.0
    assert report["position"][2] == 0.0
    assert report["velocity"] == (0.0, 0.0, 0.0)
    taken = report["taken_by_viscous_friction"] + report["taken_by_coulomb_friction"]
    assert report["work_of_felt_force"] + report["work_of_hand"] == pytest.approx(taken, rel=1e-9)


def test_a_silent_host_makes_it_limp_and_the_hand_takes_over(bench):
    device = bench(rest=(0.0, 0.0, 0.0))
    device.greet()
    for sequence in range(100):
        device.say(link.Force(sequence, (1000, 0, 0)))
        device.pass_time(STEP)
    assert not device.board.firmware.limp
    heard = device.pass_time(0.019)
    assert not any(isinstance(message, link.Fault) for message in heard)
    heard = device.pass_time(0.003)
    assert [message for message in heard if isinstance(message, link.Fault)] == [link.Fault(1, 1)]
    assert device.board.report()["felt_force"] == (0.0, 0.0, 0.0)
    device.pass_time(1.0)
    assert device.board.plant.position[0] == pytest.approx(0.0, abs=1e-9)


def test_unplugged_by_schedule_it_comes_back_at_its_path_as_a_fresh_board(bench):
    device = bench(unplug_at=0.1, unplug_for=0.2)
    device.greet()
    before = device.board.port.path
    device.pass_time(0.09)
    HostEnd(before).close()
    device.pass_time(0.02)
    assert device.board.report()["plugged"] is False
    with pytest.raises(OSError, match=r"No such file|refused"):
        HostEnd(before)
    device.pass_time(0.2)
    # The old port is still open at the host.
    assert device.board.port.path == before
    device.open()
    assert device.pass_time(0.01) == []
    hello, state = device.greet()
    assert isinstance(hello, link.DeviceHello)
    assert isinstance(state, link.State)
    assert device.board.report()["unplugged"] == 1


def test_the_button_is_pressed_by_schedule_and_by_command(bench):
    device = bench(button_at=0.05, button_for=0.02)
    device.greet()
    pressed = [state.buttons for state in states(device.pass_time(0.1))]
    assert 19 <= pressed.count(1) <= 21
    assert pressed[-1] == 0
    device.board.press_buttons(6)
    assert states(device.pass_time(STEP))[0].buttons == 6
    device.board.press_buttons(0)
    assert states(device.pass_time(STEP))[0].buttons == 0


def test_delay_holds_back_both_ways(bench):
    device = bench(delay=0.01)
    device.say(link.HostHello())
    assert device.pass_time(0.02) == []
    assert isinstance(device.pass_time(0.003)[0], link.DeviceHello)


def test_the_hand_can_be_led_away_from_its_script(bench):
    device = bench(rest=(0.0, 0.0, 0.03), by=(0.0, 0.0, -0.01))
    device.greet()
    device.pass_time(1.3)
    device.board.move_hand(device.ticks * STEP, (0.01, 0.02, 0.03), 0.1)
    device.pass_time(1.0)
    assert device.board.plant.position == pytest.approx((0.01, 0.02, 0.03), abs=1e-9)


def test_a_host_that_does_not_read_costs_frames_but_breaks_none(bench):
    device = bench()
    device.greet()
    device.close()
    device.pass_time(2.0)
    assert device.board.port.dropped > 0
    device.open()
    heard = device.pass_time(0.5)
    assert device.decoder.errors.total == 0
    assert len(states(heard)) >= 500


@pytest.mark.skipif(not HAS_PSEUDO_TERMINALS, reason="links lead to terminals")
def test_the_path_of_a_file_is_not_taken_away(tmp_path):
    path = tmp_path / "file"
    path.write_text("mine")
    with pytest.raises(PalpateError, match="something else is there"):
        device_port(str(path))
    assert path.read_text() == "mine"
    with pytest.raises(PalpateError, match="cannot be made"):
        device_port(str(tmp_path / "no" / "folder"))


@pytest.mark.parametrize(
    "option",
    [
        {"mass": 0.0},
        {"rate_hz": 0},
        {"rate_hz": 70_000},
        {"loss": 1.5},
        {"noise": -0.1},
        {"delay": -1.0},
        {"coulomb": -0.1},
        {"force_step": -1.0},
        {"jitter": float("nan")},
        {"hand_stiffness": float("nan")},
        {"unplug_at": 1.0, "unplug_for": 1.0},
    ],
)
def test_options_without_sense_are_refused(option):
    with pytest.raises(PalpateError, match="simulated device"):
        SimulatedOptions(**option)
