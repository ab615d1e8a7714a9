"""A hostile host at the C++ firmware, at the simulated board, and at boards that break a rule."""

import os
import threading
import time

import pytest

from palpate.cli.main import main
from palpate.core.errors import PalpateError
from palpate.core.servo import link
from palpate.simulated.attack.port.host_attack import HostAttack, host_table
from palpate.simulated.board.simulated_board import SimulatedBoard
from palpate.simulated.board.simulated_firmware import Firmware
from palpate.simulated.hand.options import SimulatedOptions

pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")

PATIENT = 10_000.0
"""Nothing of these tests is about how busy this machine is, ms."""


def attack(port, only=""):
    found = {}
    given = HostAttack(port, times=1, only=only, largest_force=0.1, allowance_ms=PATIENT)
    for row in host_table(given, lambda _: None).rows:
        found[row.injected] = [rule.partition(" (")[0] for rule in row.broken]
    return found


class Running:
    """A board with this firmware, in a thread."""

    def __init__(self, firmware):
        self.board = SimulatedBoard(SimulatedOptions())
        self.board.firmware = firmware(self.board.firmware.hello)
        self.port = self.board.port.path
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ends.set()
        self._thread.join()
        self.board.port.unplug()

    def _run(self):
        begin = time.perf_counter()
        while not self._ends.wait(0.001):
            self.board.tick(time.perf_counter() - begin, 1)


def test_the_firmware_for_boards_stands_it(board_program, start_talk):
    with start_talk(board_program) as talk:
        found = attack(talk.answer())
    assert len(found) == 18
    assert not any(found.values()), found


def test_the_simulated_board_stands_it_and_is_never_asked_for_more():
    with Running(Firmware) as running:
        found = attack(running.port)
    assert not any(found.values()), found
    assert 0.0 < running.board.firmware.counters.largest_force <= 0.1


class NeverLimp(Firmware):
    def watch(self, *_):
        return b""


class HearsDuplicates(Firmware):
    def _take(self, message, now):
        self._heard_sequence = (message.sequence - 1) % link.SEQUENCES
        super()._take(message, now)


class ObeysOldForces(Firmware):
    def _is_old(self, *_):
        return False


class SpeaksWithAnybody(Firmware):
    def _answer(self, protocol):
        return super()._answer(min(protocol, link.PROTOCOL))


class LeavesOutStates(Firmware):
    def state(self, now, position_um, buttons):
        told = super().state(now, position_um, buttons)
        return b"" if self._sequence % 16 == 0 else told


@pytest.mark.parametrize(
    ("firmware", "only", "broken"),
    [
        (NeverLimp, "silence", "limp is not said"),
        (HearsDuplicates, "again and again", "heard"),
        (ObeysOldForces, "2 s old", "heard"),
        (SpeaksWithAnybody, "HELLO of another", "FAULT 2 is not said"),
        (LeavesOutStates, "silence", "STATE lost or repeated"),
    ],
)
def test_boards_that_break_a_rule_are_found(firmware, only, broken):
    with Running(firmware) as running:
        (found,) = attack(running.port, only).values()
    assert any(broken in rule for rule in found), found


def test_nobody_is_pushed_without_being_asked(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", open(os.devnull))  # noqa: SIM115, PTH123 - ends with the test
    with Running(Firmware) as running:
        assert main(["devices", "attack", running.port, "--max-force", "0.3"]) == 2
        assert running.board.firmware.counters.hellos == 0
    said = capsys.readouterr().err
    assert "up to 0.3 N" in said
    assert "Give --yes to begin" in said


def test_a_port_where_nothing_answers_is_named():
    with pytest.raises(PalpateError, match="/no/such/port"):
        attack("/no/such/port")
