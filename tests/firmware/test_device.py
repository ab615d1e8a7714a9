"""The rules of the device's side of the link, in C++ and simulated, by the test's clock."""

import random
import re
from pathlib import Path

import pytest
from link_devices import Device, Simulated, decoded

from palpate.core.servo import link
from palpate.simulated.board.simulated_firmware import Firmware

HELLO = link.DeviceHello("Test", 3, 2.0, (0.125, 0.125, 0.125), 1000)
ENABLE, DAMP = link.ForceFlag.ENABLE, link.ForceFlag.DAMP
PROSE = Path(__file__).resolve().parents[2] / "docs/link.md"


def force(sequence, z_mn=1000, flags=ENABLE):
    return link.Force(sequence, (0, 0, z_mn), flags)


@pytest.fixture
def board(checker):
    board = Device(checker)
    board.new(HELLO)
    return board


@pytest.fixture
def greeted_board(board):
    assert board.hear(link.HostHello(), 0) == [HELLO]
    return board


@pytest.fixture(params=["C++", "simulated"])
def device(request):
    if request.param == "C++":
        return request.getfixturevalue("board")
    device = Simulated()
    device.new(HELLO)
    return device


@pytest.fixture
def greeted(device):
    assert device.hear(link.HostHello(), 0) == [HELLO]
    return device


LIMP = ("limp", False, False, (0.0, 0.0, 0.0))


def test_nothing_is_said_and_nothing_obeyed_before_hello(device):
    assert device.state(0) == []
    assert device.hear(force(0), 0) == []
    assert device.drive(0) == (("waiting", False, False, (0.0, 0.0, 0.0)), [])
    assert device.counters()["unexpected"] == 1


def test_every_hello_is_answered_and_the_stream_begins(device):
    assert device.hear(link.encode(link.HostHello()) * 3, 0) == [HELLO] * 3
    ready = link.StateFlag.READY
    assert device.state(250_000, (1, -2, 3), 1) == [link.State(0, 250_000, (1, -2, 3), 1, ready)]
    assert device.state(500_000, (4, 5, 6)) == [link.State(1, 500_000, (4, 5, 6), 0, ready)]


def test_an_orientation_bears_the_number_of_the_state_to_come(device):
    assert device.orientation(1.0, 0.0, 0.0, 0.0) == []
    device.hear(link.HostHello(), 0)
    for sequence in range(3):
        # Told twice is told once; it is the STATE that counts on.
        for _ in range(2):
            told = device.orientation(0.6, 0.0, -0.8, 0.0)
            assert told == [link.orientation(sequence, (0.6, 0.0, -0.8, 0.0))]
        assert device.state(1000 * sequence)[0].sequence == sequence
    assert device.orientation(0.0, 0.985, 0.0, 0.18) != []


@pytest.mark.parametrize("part", [float("nan"), float("inf"), 0.0, 0.985, 1.015, -1e30])
def test_what_is_no_rotation_is_not_told(greeted_board, part):
    assert greeted_board.ask(f"orientation 0 {part!r} 0 0") == "-"


def test_a_board_that_is_not_ready_says_so(greeted_board):
    assert greeted_board.state(600_000, ready=0)[0].flags == 0


def test_the_board_rounds_orientations_as_this_side_does(greeted_board):
    dice = random.Random(3)  # noqa: S311 - no secret
    for _ in range(100):
        turn = [dice.gauss(0.0, 1.0) for _ in range(4)]
        length = sum(part**2 for part in turn) ** 0.5
        turn = tuple(part / length for part in turn)
        (told,) = greeted_board.orientation(*turn)
        ours = link.orientation(0, turn)
        # The board's arithmetic is of single precision.
        parts = zip(told.quaternion, ours.quaternion, strict=True)
        assert all(abs(a - b) <= 1 for a, b in parts)
        assert told.is_unit


def test_another_protocol_ends_stream_and_force(greeted):
    greeted.hear(force(0), 0)
    fault = link.Fault(2, 9)
    assert greeted.hear(link.HostHello(9), 1000) == [HELLO, fault]
    assert greeted.state(1000) == []
    assert greeted.hear(force(1), 1000) == []
    assert greeted.force(1000) == (0.0, 0.0, 0.0)


def test_a_device_of_another_protocol_says_so_to_this_host(checker):
    device = Device(checker)
    device.new(link.DeviceHello("Later", 3, 1.0, (0, 0, 0), 1000, protocol=3))
    assert device.hear(link.HostHello(9), 0) == [link.OtherHello(3), link.Fault(2, 9)]
    assert device.state(0) == []


def test_force_acts_only_when_enabled_and_damping_also_without(greeted):
    greeted.hear(force(0), 0)
    assert greeted.drive(0)[0] == ("driven", True, False, (0.0, 0.0, 1.0))
    greeted.hear(force(1, flags=0), 0)
    assert greeted.drive(0)[0] == ("driven", False, False, (0.0, 0.0, 0.0))
    greeted.hear(force(2, flags=DAMP), 0)
    assert greeted.drive(0)[0] == ("driven", False, True, (0.0, 0.0, 0.0))
    greeted.hear(force(3, flags=ENABLE | DAMP), 0)
    assert greeted.drive(0)[0] == ("driven", True, True, (0.0, 0.0, 1.0))


@pytest.mark.parametrize("start", [1_000_000, 2**32 - 10_000])
def test_twenty_milliseconds_of_silence_make_it_limp_and_it_says_so_once(greeted, start):
    def at(later):
        return (start + later) % 2**32

    greeted.hear(force(0, flags=ENABLE | DAMP), at(0))
    assert greeted.drive(at(19_999)) == (("driven", True, True, (0.0, 0.0, 1.0)), [])
    assert greeted.drive(at(greeted.silence_us)) == (LIMP, [link.Fault(1, 1)])
    assert greeted.drive(at(30_000)) == (LIMP, [])
    greeted.hear(force(700), at(31_000))
    assert greeted.force(at(31_000)) == (0.0, 0.0, 1.0)
    assert greeted.drive(at(31_000 + greeted.silence_us))[1] == [link.Fault(1, 2)]
    assert greeted.counters()["lost"] == 0


def test_a_force_after_silence_that_nobody_noticed_still_finds_the_watchdog(greeted_board):
    greeted_board.hear(force(500), 0)
    assert greeted_board.hear(force(3), 30_000) == [link.Fault(1, 1)]
    assert greeted_board.force(30_000) == (0.0, 0.0, 1.0)


def test_damaged_forces_do_not_keep_it_going(greeted):
    greeted.hear(force(0), 0)
    whole = link.encode(force(1, 500))
    for place in range(len(whole) - 1):
        damaged = bytearray(whole)
        damaged[place] ^= 0x40
        greeted.hear(bytes(damaged), 15_000)
    assert greeted.force(15_000) == (0.0, 0.0, 1.0)
    assert greeted.drive(greeted.silence_us) == (LIMP, [link.Fault(1, 1)])
    seen = greeted.counters()
    assert seen["crc_errors"] + seen["malformed"] == len(whole) - 1
    assert seen["crc_errors"] > 5


def test_repeated_and_late_forces_are_counted_and_do_not_keep_it_going(greeted):
    greeted.hear(force(10, 500), 0)
    for sequence in (10, 9, 10 + 0x8000):
        greeted.hear(force(sequence, 900), 15_000)
    assert greeted.force(15_000) == (0.0, 0.0, 0.5)
    assert (greeted.counters()["duplicates"], greeted.counters()["late"]) == (1, 2)
    assert greeted.drive(greeted.silence_us)[0] == LIMP


def test_the_furthest_ahead_is_in_order_with_all_between_lost(greeted):
    greeted.hear(force(65_000), 0)
    greeted.hear(force((65_000 + 0x7FFF) % 2**16, 750), 0)
    assert greeted.force(0) == pytest.approx((0.0, 0.0, 0.75))
    assert (greeted.counters()["lost"], greeted.counters()["late"]) == (0x7FFE, 0)


def test_gaps_are_counted_also_where_the_sequence_wraps(greeted):
    for sequence in (65533, 65534, 1, 2, 5):
        greeted.hear(force(sequence), 0)
    assert (greeted.counters()["lost"], greeted.counters()["forces"]) == (2 + 2, 5)


def test_more_than_the_largest_force_is_shortened(greeted):
    greeted.hear(link.Force(0, (3000, 0, 4000)), 0)
    assert greeted.force(0) == pytest.approx((1.2, 0.0, 1.6))
    greeted.hear(link.Force(1, (-32768, -32768, -32768)), 0)
    assert greeted.force(0) == pytest.approx((-(2 / 3**0.5),) * 3)


def test_what_is_no_number_never_reaches_the_motors(checker):
    for vector, limit in (
        (("nan", 0, 0), 1),
        (("inf", 0, 0), 1),
        ((1, 2, 3), "nan"),
        ((1, 0, 0), -1),
    ):
        words = " ".join(map(str, vector))
        assert checker.ask(f"shorten {words} {limit}").split() == ["0", "0", "0"]


def test_a_device_with_impossible_figures_gives_no_force(checker):
    checker.ask(f"device 1 {'00' * 16} 3 nan 0 0 0 1000")
    device = Device(checker)
    device.hear(link.HostHello(), 0)
    device.hear(force(0), 0)
    assert device.force(0) == (0.0, 0.0, 0.0)
    assert device.state(0)[0].flags == 0


def test_hello_in_between_begins_a_new_session(greeted):
    greeted.hear(force(10), 0)
    assert greeted.hear(link.HostHello(), 1000) == [HELLO]
    assert greeted.drive(1000) == (LIMP, [])
    greeted.hear(force(0), 2000)
    assert greeted.force(2000) == (0.0, 0.0, 1.0)


def test_a_fault_of_its_own_is_told_once_shown_always_and_gives_no_force(greeted_board):
    greeted_board.hear(force(0, flags=ENABLE | DAMP), 0)
    assert decoded(greeted_board.ask("fail 130 77")) == [link.Fault(130, 77)]
    assert greeted_board.ask("fail 130 78") == "-"
    assert greeted_board.state(0)[0].flags == link.StateFlag.FAULT
    greeted_board.hear(force(1, flags=ENABLE | DAMP), 0)
    assert greeted_board.drive(0) == (("failed", False, False, (0.0, 0.0, 0.0)), [])
    greeted_board.ask("recover")
    assert greeted_board.state(0)[0].flags == link.StateFlag.READY
    # Not at once and in full: the force from before is void, the next one is obeyed.
    assert greeted_board.force(0) == (0.0, 0.0, 0.0)
    greeted_board.hear(force(2, 300), 0)
    assert greeted_board.force(0) == pytest.approx((0.0, 0.0, 0.3))


def test_a_fault_from_before_hello_is_told_after_it(board):
    assert board.ask("fail 128 1") == "-"
    assert board.hear(link.HostHello(), 0) == [HELLO, link.Fault(128, 1)]


def test_started_again_it_waits_for_hello(greeted):
    greeted.hear(force(0), 0)
    greeted.hear(b"\5half", 0)
    greeted.restart()
    assert greeted.state(0) == []
    assert greeted.hear(link.HostHello(), 0) == [HELLO]
    assert greeted.drive(0)[0] == LIMP


def test_sound_frames_that_a_host_does_not_send_are_counted(greeted_board):
    for message in (link.State(0, 0, (0, 0, 0)), link.Fault(1, 2), HELLO):
        assert greeted_board.hear(message, 0) == []
    assert greeted_board.hear(link.frame(b"\x03\0\0"), 0) == []
    assert greeted_board.counters()["unknown"] == 4


def test_the_conversation_in_the_documentation_is_so_to_the_byte(checker):
    section = PROSE.read_text(encoding="utf-8").split("### A conversation\n")[1].split("### ")[0]
    lines = re.findall(r"^ +(\d+)  (host|device) +((?:[0-9A-F]{2} ?)+)$", section, re.MULTILINE)
    assert len(lines) == 12
    device = Device(checker)
    device.new(link.DeviceHello("Simulated", 3, 3.0, (0.125, 0.125, 0.0625), 1000))
    said, modes = b"", []
    for time, speaker, text in lines:
        now, data = int(time), bytes.fromhex(text)
        if speaker == "host":
            assert said == b""
            said = bytes.fromhex(device.ask(f"hear {now} {data.hex()}").replace("-", ""))
        elif data[1:2] == b"\2":
            said += bytes.fromhex(device.ask(f"state {now} 12345 -6789 30000 0 1"))
        mode, *_, rest = device.ask(f"drive {now}").split()
        said += bytes.fromhex(rest.replace("-", ""))
        modes.append(mode)
        if speaker == "device":
            assert said == data
            said = b""
    assert modes == ["limp"] * 3 + ["driven"] * 4 + ["limp"] * 2 + ["driven"] + ["waiting"] * 2
    assert device.counters()["duplicates"] == 1


def test_it_behaves_as_the_simulated_device_does(checker):
    """Two devices that know nothing of each other hear the same host, good and bad, for a while."""
    dice = random.Random(4)  # noqa: S311 - dice for a host's whims, not secrets
    ours, simulated = Device(checker), Firmware(HELLO)
    ours.new(HELLO)
    now, sequence = 0, 65_000
    for _ in range(3000):
        # Odd steps: the two differ in whether 20 ms to the microsecond are silence yet.
        now += dice.choice([300, 999, 1001, 4001, 21_001])
        match dice.randrange(12):
            case 0:
                data = link.encode(link.HostHello())
            case 1:
                data = dice.randbytes(dice.randrange(1, 40)) + b"\0"
            case 2:
                data = link.encode(force(sequence - dice.randrange(3)))
            case _:
                sequence = (sequence + dice.choice([1, 1, 1, 2, 40])) % 2**16
                newtons = tuple(dice.randrange(-2500, 2500) for _ in range(3))
                data = link.encode(link.Force(sequence, newtons, dice.randrange(4)))
        said = simulated.watch(now * 1e-6) + simulated.receive(data, now * 1e-6)
        _, ours_said = ours.drive(now)
        assert ours_said + ours.hear(data, now) == link.Decoder().feed(said)
        (mode, _, damp, newtons), _ = ours.drive(now)
        assert newtons == pytest.approx(simulated.force, abs=2e-3)
        if simulated.streaming:
            assert (mode == "limp", damp) == (simulated.limp, simulated.braked)
    seen, expected = ours.counters(), simulated.counters
    assert (seen["forces"], seen["lost"], seen["limp"]) == (
        expected.forces,
        expected.lost,
        expected.limp_count,
    )
    assert (seen["duplicates"], seen["late"]) == (expected.duplicates, expected.out_of_order)
    assert min(seen["limp"], seen["duplicates"], seen["late"], seen["lost"]) > 20


def test_the_library_takes_no_heap_and_older_compilers_take_the_library(compiler):
    source = compiler.folder / "library_alone.cpp"
    source.write_text(
        "#include <palpate_link.h>\n"
        "bool talk(palpate::Device& device) {\n"
        "  uint8_t frame[palpate::max_frame];\n"
        "  device.receive(1, 2);\n"
        "  device.drive(3);\n"
        "  return device.answer(frame) + device.state(4, {1, 2, 3}, 5, true, frame) > 0;\n"
        "}\n"
    )
    made = compiler.folder / "library_alone.o"
    for standard in ("c++11", "c++17", "c++20"):
        bare = ("-c", "-O1", "-fno-exceptions", "-fno-rtti", f"-o{made}")
        compiler.run(compiler.command([source], *bare, standard=standard))
        names = made.read_bytes()
        assert b"talk" in names
        for allocator in (b"malloc", b"_Znw", b"_Zna", b"__cxa_throw"):
            assert allocator not in names
