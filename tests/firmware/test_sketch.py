"""The sketch itself, with its places filled in, on an Arduino whose clock the test turns."""

import itertools
from pathlib import Path

import pytest

from palpate.core.servo import link

REPOSITORY = Path(__file__).resolve().parents[2]
ENABLE, DAMP = link.ForceFlag.ENABLE, link.ForceFlag.DAMP
HELLO = link.DeviceHello("Filled in", 3, 2.0, (0.0625, 0.125, 0.25), 1000)
PASS_US = 50


class Sketch:
    """The runner, by messages instead of lines."""

    def __init__(self, talk):
        self.ask = talk.ask
        self.sequence = 0

    def hear(self, *messages):
        self.ask("hear " + b"".join(map(link.encode, messages)).hex())

    def force(self, x=0, y=0, z=0, flags=ENABLE):
        self.hear(link.Force(self.sequence, (x, y, z), flags))
        self.sequence += 1

    def run(self, microseconds):
        self.ask(f"run {microseconds}")

    def said_in_full(self):
        decoder = link.Decoder()
        messages = decoder.feed(bytes.fromhex(self.ask("said")))
        assert decoder.errors.total == 0
        return messages

    def said(self):
        """Without how the stylus is turned."""
        return [m for m in self.said_in_full() if not isinstance(m, link.Orientation)]

    def motors(self):
        on, *force = self.ask("motors").split()
        return on == "1", tuple(map(float, force))


@pytest.fixture
def sketch(sketch_program, start_talk):
    with start_talk(sketch_program) as talk:
        yield Sketch(talk)


@pytest.fixture
def greeted(sketch):
    sketch.hear(link.HostHello())
    sketch.run(PASS_US)
    assert sketch.said()[0] == HELLO
    return sketch


OFF = (False, (0.0, 0.0, 0.0))


def test_as_delivered_it_compiles_and_only_measures(compiler, start_talk):
    here, sketch = REPOSITORY / "tests/firmware", REPOSITORY / "firmware/palpate_device"
    options = (f"-I{here / 'arduino'}", f"-I{sketch}")
    program = compiler.build("delivered", [here / "sketch_runner.cpp"], *options)
    with start_talk(program) as talk:
        sketch = Sketch(talk)
        sketch.hear(link.HostHello(), link.Force(0, (0, 0, 1000)))
        sketch.run(2000)
        hello, *states = sketch.said_in_full()
        assert (hello.name, hello.largest_force) == ("My device", 0.0)
        assert [state.flags for state in states] == [0, 0]


def test_it_streams_at_its_rate_where_the_tip_is(greeted):
    greeted.ask("counts 1 -2 300")
    greeted.ask("pin 3 0")
    greeted.run(10_000)
    states = greeted.said()
    assert len(states) == 10
    last = states[-1]
    assert (last.position_um, last.buttons, last.flags) == ((20, -40, 6000), 2, 1)
    times = [state.device_time_us for state in states]
    assert [later - sooner for sooner, later in itertools.pairwise(times)] == [1000] * 9


def test_it_tells_how_the_stylus_is_turned_before_each_state(greeted):
    greeted.ask("turned 0.99 0 0 0.141")
    greeted.run(3000)
    said = greeted.said_in_full()
    assert [type(message) for message in said] == [link.Orientation, link.State] * 3
    for orientation, state in zip(said[::2], said[1::2], strict=True):
        assert orientation.sequence == state.sequence
        assert orientation == link.orientation(state.sequence, (0.99, 0.0, 0.0, 0.141))


@pytest.mark.parametrize("trouble", ["gimbal 0", "turned 0.5 0 0 0", "turned nan 0 0 0"])
def test_an_orientation_that_is_none_is_not_told_and_the_place_is(greeted, trouble):
    greeted.ask(trouble)
    greeted.run(3000)
    assert [type(message) for message in greeted.said_in_full()] == [link.State] * 3


def test_with_encoders_that_do_not_answer_no_orientation_is_told(greeted):
    greeted.ask("encoders 0")
    greeted.run(2000)
    assert [type(m) for m in greeted.said_in_full()] == [link.State, link.Fault, link.State]


def test_it_pushes_as_told_within_its_largest(greeted):
    greeted.force(300, -400, 500)
    greeted.run(1000)
    assert greeted.motors() == (True, pytest.approx((0.3, -0.4, 0.5)))
    greeted.force(3000, 0, 4000)
    greeted.run(1000)
    assert greeted.motors() == (True, pytest.approx((1.2, 0.0, 1.6)))
    greeted.force(flags=0)
    greeted.run(PASS_US)
    assert greeted.motors() == OFF


@pytest.mark.parametrize("clock", [5_000_000, 2**32 - 5_000])
def test_motors_are_off_twenty_milliseconds_after_the_last_force(greeted, clock):
    greeted.ask(f"clock {clock}")
    greeted.force(z=1000)
    greeted.run(PASS_US)
    greeted.run(1000)
    assert greeted.motors()[0]
    passed = 1000 + int(greeted.ask("until-off 100000"))
    assert 20_000 <= passed <= 20_000 + PASS_US
    assert greeted.motors() == OFF
    assert link.Fault(1, 1) in greeted.said()


def test_motors_go_off_also_when_nobody_reads_the_port(greeted):
    greeted.force(z=1000)
    greeted.run(1000)
    greeted.said()
    greeted.ask("room 10")
    greeted.run(30_000)
    assert greeted.motors() == OFF
    assert greeted.said() == []
    # What had no room is told when there is some; STATE only anew.
    greeted.ask("room 256")
    greeted.run(1000)
    assert [type(message) for message in greeted.said()] == [link.Fault, link.State]


def test_a_flood_of_bytes_does_not_hold_the_watchdog_up(greeted):
    greeted.force(z=1000)
    greeted.run(1000)
    for _ in range(30):
        greeted.ask("hear " + "a5" * 1280)
        greeted.run(1000)
    assert greeted.motors() == OFF


def test_damping_brakes_against_the_movement(greeted):
    for count in range(100):
        greeted.ask(f"counts {5 * count} 0 0")
        greeted.force(flags=DAMP)
        greeted.run(1000)
    on, force = greeted.motors()
    # 100 um a millisecond is 0.1 m/s, and 2 N s/m.
    assert on
    assert force == pytest.approx((-0.2, 0.0, 0.0), abs=1e-3)


@pytest.mark.parametrize(("cause", "code"), [("encoders 0", 128), ("healthy 0", 129)])
def test_a_broken_part_ends_the_force_for_good(greeted, cause, code):
    greeted.force(z=1000)
    greeted.run(1000)
    greeted.ask(cause)
    greeted.run(1000)
    assert greeted.motors() == OFF
    assert link.Fault(code, 0) in greeted.said()
    greeted.ask(cause.replace("0", "1"))
    greeted.force(z=1000)
    greeted.run(2000)
    assert greeted.motors() == OFF
    assert [message.flags for message in greeted.said()] == [link.StateFlag.FAULT] * 2


def test_the_heartbeat_stops_with_the_host(greeted):
    assert greeted.ask("turns 5") == "0"
    greeted.force(z=1000)
    greeted.run(10_000)
    beats = int(greeted.ask("turns 5"))
    assert beats >= 199
    greeted.run(11_000)
    stopped = greeted.ask("turns 5")
    greeted.run(10_000)
    assert greeted.ask("turns 5") == stopped
