"""The servo and the firmware's protocol part, which has never heard of it, on a pseudo-terminal."""

import contextlib
import json

import numpy as np
import pytest
from palpate_servo import LinkDevice, Servo

from palpate.core.servo.settings import Settings
from palpate.simulated.attack.real.host import Host
from palpate.simulated.attack.target import cube

ABOVE = (0.026, 0.024, 0.06)
DEEP = (0.026, 0.024, 0.044)


class Board:
    """The host program: the port is its first line."""

    def __init__(self, talk):
        self.tell, self._ask = talk.tell, talk.ask
        self.port = talk.answer()

    def report(self):
        return json.loads(self._ask("report"))

    def move(self, metres, milliseconds=0):
        x, y, z = np.multiply(metres, 1e6)
        self.tell(f"move {x:.9g} {y:.9g} {z:.9g} {milliseconds}")


@pytest.fixture
def start_board(board_program, start_talk):
    started = []

    def start(*arguments):
        talk = start_talk(board_program, *arguments)
        started.append(talk)
        board = Board(talk)
        board.move(ABOVE)
        return board

    yield start
    for talk in started:
        talk.__exit__()


@pytest.fixture
def protocol():
    return 2


@pytest.fixture
def board(start_board, protocol):
    return start_board("--protocol", str(protocol))


@pytest.fixture(scope="module")
def body():
    return cube()


@pytest.fixture
def servo(body):
    with Servo(body, Settings(10_000.0), ramp_seconds=0.05) as servo:
        yield servo


def state_is(servo, state):
    return lambda: servo.snapshot().state == state


@pytest.fixture
def press(board, servo, eventually):
    servo.start(LinkDevice(board.port))
    eventually(state_is(servo, "free"), servo.snapshot)
    board.move(DEEP, 300)
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)


@pytest.mark.parametrize("protocol", [1, 2])
def test_hello_states_and_forces_go_through(press, board, servo, eventually, protocol):
    eventually(lambda: np.allclose(servo.snapshot().probe, DEEP, atol=1e-6), servo.snapshot)
    eventually(lambda: np.allclose(servo.snapshot().output_force, servo.snapshot().contact_force))
    force = servo.snapshot().output_force
    assert force[2] > 0.3
    eventually(lambda: np.allclose(board.report()["force"], force, atol=0.6e-3), board.report)
    assert not board.report()["damp"]
    assert servo.counters()["link"]["device"] == {
        "name": "Reference",
        "protocol": protocol,
        "axes": 3,
        "max_force": 3.0,
        "half_extents": pytest.approx([0.1, 0.1, 0.1]),
        "rate_hz": 1000,
        "largest_damping": 0.0,
    }
    round_trip = servo.counters()["link"]["round_trip_ms"]
    assert (round_trip is None) == (protocol == 1)
    assert board.report()["refused"] == 0


def test_a_clean_line_loses_nothing_either_way(press, board, servo, eventually):
    eventually(lambda: servo.counters()["link"]["forces"] > 300)
    servo.stop()
    seen = servo.counters()["link"]
    eventually(lambda: board.report()["forces"] == seen["forces"], board.report)
    report = board.report()
    for name in ("lost", "duplicates", "late", "unknown", "unexpected", "crc_errors", "malformed"):
        assert report[name] == 0, name
    for name in ("duplicates", "out_of_order", "unknown", "crc_errors", "cobs_errors", "oversize"):
        assert seen[name] == 0, name
    # What the servo said last was: let go.
    assert (report["enabled"], report["force"]) == (False, [0.0, 0.0, 0.0])


def test_a_stylus_that_is_told_no_more_is_a_fault_until_it_is_told_again(board, servo, eventually):
    def seen(name):
        return servo.counters()["link"][name]

    board.tell("turn 0.6 0 0.8 0")
    servo.start(LinkDevice(board.port))
    eventually(state_is(servo, "free"), servo.snapshot)
    eventually(lambda: seen("orientations") > 100, servo.counters)
    assert seen("orientations_lost") == seen("orientations_unpaired") == seen("unknown") == 0
    board.move(DEEP, 300)
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)
    # What is no rotation is not told; the place is.
    board.tell("turn 0.6 0 0 0")
    eventually(lambda: servo.snapshot().fault == "stale", servo.snapshot)
    states = seen("states")
    eventually(lambda: seen("states") > states + 20, servo.counters)
    assert servo.snapshot().fault == "stale"
    assert board.report()["force"] == [0.0, 0.0, 0.0]
    board.tell("turn -0.6 0 -0.8 0")
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)


def test_the_devices_largest_force_holds_at_both_ends(body, start_board, eventually):
    board = start_board("--largest", "0.25")
    with Servo(body, Settings(10_000.0)) as servo:
        servo.start(LinkDevice(board.port))
        eventually(state_is(servo, "free"), servo.snapshot)
        board.move(DEEP, 300)
        eventually(lambda: np.linalg.norm(board.report()["force"]) > 0.249, board.report)
        assert np.linalg.norm(servo.snapshot().output_force) <= 0.25 + 1e-6
    assert board.report()["strongest"] <= 0.25 + 1e-6


def test_a_board_that_hears_nothing_goes_limp_and_says_so(press, board, servo, eventually):
    before = board.report()["limp"]
    board.tell("deaf 1")
    eventually(lambda: board.report()["mode"] == "limp", board.report)
    assert board.report()["force"] == [0.0, 0.0, 0.0]
    times = board.report()["limp"]
    assert times > before
    eventually(lambda: servo.counters()["link"]["last_fault"] == (1, times), servo.counters)
    # STATE goes on meanwhile, and the next FORCE is obeyed whatever its number.
    states = board.report()["states"]
    eventually(lambda: board.report()["states"] > states + 20, board.report)
    board.tell("deaf 0")
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)
    assert servo.counters()["faults"]["device fault"] >= 1


def test_a_host_that_is_killed_leaves_the_board_limp(board, servo, eventually):
    def starts():
        # The killed host's lock on the port lasts until the board has noticed.
        with contextlib.suppress(OSError):
            servo.start(LinkDevice(board.port))
        return servo.running

    with Host(board.port):
        eventually(lambda: board.report()["enabled"], board.report)
        board.move(DEEP, 300)
        eventually(lambda: board.report()["force"][2] > 0.3, board.report)
    eventually(lambda: board.report()["mode"] == "limp", board.report)
    report = board.report()
    assert report["force"] == [0.0, 0.0, 0.0]
    # By the board's own clock; as much later as the system let the board itself wait.
    assert 0 < report["limp_after_us"] <= 20_000 + report["limp_look_us"]
    board.move(ABOVE)
    eventually(starts)
    eventually(state_is(servo, "free"), servo.snapshot)
    board.move(DEEP, 300)
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)


def test_damage_in_the_middle_of_a_press_is_counted_and_survived(press, board, eventually):
    board.tell("hit 40")
    eventually(lambda: board.report()["crc_errors"] + board.report()["malformed"] > 0, board.report)
    forces = board.report()["forces"]
    eventually(lambda: board.report()["forces"] > forces + 20, board.report)
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)
    assert board.report()["strongest"] <= 3.0 + 1e-6


def test_a_board_that_falls_silent_is_stale_and_greeted_again(press, board, servo, eventually):
    hellos = board.report()["hellos"]
    board.tell("mute 1")
    eventually(lambda: servo.snapshot().fault == "stale", servo.snapshot)
    assert not servo.snapshot().output_force.any()
    eventually(lambda: board.report()["hellos"] > hellos, board.report)
    board.tell("mute 0")
    eventually(lambda: board.report()["force"][2] > 0.3, board.report)
    assert servo.counters()["faults"]["stale"] >= 1
