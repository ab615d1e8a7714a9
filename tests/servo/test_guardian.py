"""The guardian: whatever ends a host, the last word on the line is zero."""

import os
import signal
import sys
import time
from dataclasses import dataclass

import pytest

from palpate.simulated.attack.real import guardians, lost_guardians, processes
from palpate.simulated.attack.real.desk import KINDS, desk
from palpate.simulated.attack.real.host import NotReachedError
from palpate.simulated.attack.real.line.pulse import Pulse
from palpate.simulated.attack.real.trials import trials

if sys.platform != "linux":
    # As a whole, since its parameters are signals that Windows does not have.
    pytest.skip("looks for processes in /proc", allow_module_level=True)


# Ended at once, by a fault of its own, and stopped; the others end like one of these.
SOME = (signal.SIGKILL, signal.SIGSEGV, signal.SIGSTOP)


@pytest.fixture(params=KINDS)
def at(request):
    with desk(request.param) as at:
        yield at


@pytest.mark.parametrize(
    "number",
    [
        pytest.param(one, id=one.name, marks=[] if one in SOME else [pytest.mark.at_length])
        for one in guardians.SIGNALS
    ],
)
def test_the_last_word_is_zero(number, at):
    last = guardians.end_by(number, at)
    assert last.pushed
    assert last.words
    assert not last.words[-1].pushes


def test_the_last_word_is_zero_on_a_port_that_another_has_taken(at):
    last = guardians.end_by(signal.SIGKILL, at, taken=True)
    assert last.pushed
    assert last.words
    assert not last.words[-1].pushes


def test_it_ends_with_its_host_and_hears_nothing_that_the_group_is_told():
    with processes.device() as hand, processes.Host(hand.port) as host:
        processes.press(host, hand)
        (own,) = guardians.guardians(host.process.pid)
        assert os.getsid(own) == own != os.getsid(host.process.pid)
        for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
            os.kill(own, number)
        processes.press(host, hand)
        assert own in guardians.guardians()
        assert host.end() == 0
        assert own not in guardians.guardians()


def test_a_host_that_goes_on_has_its_port_back():
    with processes.device() as hand, processes.Host(hand.port) as host:
        suspension = processes.suspend(host, hand, 0.1)
        assert suspension.problems() == []
        processes.press(host, hand)


@dataclass
class Tried:
    held_up_ms: float


def test_what_the_computer_held_up_is_not_judged_and_tried_again():
    coming = iter([9.0, 1.0, None, 7.0, 2.0, 3.0])

    def once():
        held_up_ms = next(coming)
        if held_up_ms is None:
            raise NotReachedError("nothing was pressed")
        return Tried(held_up_ms)

    tried = trials(3, once)
    assert [one.held_up_ms for one in tried.judged] == [1.0, 2.0, 3.0]
    assert tried.held_up == 3
    assert "3 more not judged" in tried.note


def test_where_nothing_can_be_judged_the_row_says_so():
    tried = trials(2, lambda: Tried(50.0))
    assert not tried.judged
    row = guardians.ending_row("a signal", "(no host)", [], float("inf"), tried.note)
    assert "this computer was held up: not judged" in row.broken


def test_a_line_beside_tells_how_long_bytes_take():
    with Pulse() as pulse:
        begin = time.monotonic()
        time.sleep(0.1)
        end = time.monotonic()
        time.sleep(0.05)
    assert 1.0 < pulse.longest_ms(begin, end) < 1e3 * (end - begin)
    # Nothing came in an hour that is not over.
    assert pulse.longest_ms(end, end + 3600.0) > 3.5e6


@pytest.mark.parametrize("number", lost_guardians.SIGNALS, ids=lambda number: number.name)
def test_one_that_is_lost_is_noticed_and_another_takes_its_place(number, at):
    loss = lost_guardians.lose(at, number)
    assert loss.pushed
    assert loss.unguarded == 1
    assert loss.ms_to_zero < float("inf")
    # And the second does what the first would have done.
    assert loss.last.words
    assert not loss.last.words[-1].pushes
