"""A hostile host at the C++ firmware, at the simulated board, and at boards that break a rule."""

import os
import threading
import time
from random import Random

import pytest

from palpate.cli.main import main
from palpate.core.errors import PalpateError
from palpate.core.servo import link
from palpate.simulated.attack.port.conversation import Conversation
from palpate.simulated.attack.port.host_attack import HELD_UP, HostAttack, host_table, table_of
from palpate.simulated.board.simulated_board import SimulatedBoard
from palpate.simulated.board.simulated_firmware import Firmware
from palpate.simulated.hand.options import SimulatedOptions

pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")

PATIENT = 10_000.0
"""Nothing of these tests is about how busy this machine is, ms."""


def broken_rules(table):
    return {row.injected: [rule.partition(" (")[0] for rule in row.broken] for row in table.rows}


def attack_in_virtual_time(firmware, *only):
    """What such a board breaks; no clock, no line and no other process have a part in it."""
    board = VirtualBoard(firmware)
    dice = Random(1)  # noqa: S311 - a hostile host, no secret
    talk = Conversation(board, 100, dice, lambda: board.now, board.wait)
    given = HostAttack("", times=1, only=only, largest_force=0.1)
    return broken_rules(table_of(talk, given, lambda _: None)), board


class VirtualBoard:
    """A firmware at the end of a line of no length, in virtual time; a port for a host."""

    port = "virtual"
    period = 1e-3

    def __init__(self, firmware):
        self.firmware = firmware(SimulatedOptions().hello)
        self.now, self._ticks, self._to_host = 0.0, 0, b""

    @property
    def in_waiting(self):
        return len(self._to_host)

    def read(self, size):
        data, self._to_host = self._to_host[:size], self._to_host[size:]
        return data

    def write(self, data):
        self._to_host += self.firmware.receive(data, self.now)

    def wait(self, seconds):
        self.now += seconds
        while self._ticks * self.period <= self.now:
            self._ticks += 1
            self._to_host += self.firmware.watch(self.now, self.period)
            self._to_host += self.firmware.state(self.now, (0, 0, 0), 0)


class Running:
    """A simulated board in a thread."""

    def __init__(self):
        self.board = SimulatedBoard(SimulatedOptions())
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
        given = HostAttack(talk.answer(), times=1, largest_force=0.1, allowance_ms=PATIENT)
        found = broken_rules(host_table(given, lambda _: None))
    assert len(found) == 18
    judged = {name: rules for name, rules in found.items() if rules != [HELD_UP]}
    assert len(judged) > 9, "too busy a machine"
    assert not any(judged.values()), judged


def test_the_simulated_board_stands_it_and_is_never_asked_for_more():
    found, board = attack_in_virtual_time(Firmware)
    assert len(found) == 18
    assert not any(found.values()), found
    assert 0.0 < board.firmware.counters.largest_force <= 0.1


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
    (found,) = attack_in_virtual_time(firmware, only)[0].values()
    assert any(broken in rule for rule in found), found


def test_nobody_is_pushed_without_being_asked(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", open(os.devnull))  # noqa: SIM115, PTH123 - ends with the test
    with Running() as running:
        assert main(["devices", "attack", running.port, "--max-force", "0.3"]) == 2
        assert running.board.firmware.counters.hellos == 0
    said = capsys.readouterr().err
    assert "up to 0.3 N" in said
    assert "Give --yes to begin" in said


def test_a_port_where_nothing_answers_is_named():
    with pytest.raises(PalpateError, match="/no/such/port"):
        host_table(HostAttack("/no/such/port"), lambda _: None)
