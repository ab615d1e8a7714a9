"""The guardian: whatever ends a host, the last word on the line is zero."""

import os
import signal
import sys

import pytest

from palpate.simulated.attack.real import guardians, lost_guardians, processes
from palpate.simulated.attack.real.desk import KINDS, desk

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")


@pytest.fixture(params=KINDS)
def at(request):
    with desk(request.param) as at:
        yield at


@pytest.mark.parametrize("number", guardians.SIGNALS, ids=lambda number: number.name)
def test_the_last_word_is_zero(number, at):
    last = guardians.end_by(number, at)
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


@pytest.mark.parametrize("number", lost_guardians.SIGNALS, ids=lambda number: number.name)
def test_one_that_is_lost_is_noticed_and_another_takes_its_place(number, at):
    loss = lost_guardians.lose(at, number)
    assert loss.pushed
    assert loss.unguarded == 1
    assert loss.ms_to_zero < float("inf")
    # And the second does what the first would have done.
    assert loss.last.words
    assert not loss.last.words[-1].pushes
