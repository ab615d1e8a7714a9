"""What the system does to processes: stopped, killed, starved of readers. All of it is real."""

import os

import pytest

from palpate.simulated.attack.real import processes as fault_processes
from palpate.simulated.attack.real.stalled_reader import stalled_reader_row

pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")


@pytest.fixture
def hand():
    with fault_processes.device() as hand:
        yield hand


def test_a_host_that_was_stopped_for_a_second_begins_again_from_nothing(hand):
    with fault_processes.Host(hand.port) as host:
        suspension = fault_processes.suspend(host, hand)
    assert suspension.problems() == []
    assert suspension.gap > 0.9
    assert suspension.counted >= 1


def test_the_device_of_a_host_that_was_killed_is_limp_within_20_ms_of_its_own_clock(hand):
    report = fault_processes.kill(hand.port, hand)
    assert fault_processes.device_problems(report) == []
    assert report["largest_force"] > 0.3
    # 20 ms, unless the system let the device itself wait.
    assert report["limp_after"] <= max(0.020, report["limp_look"] + 0.019)


def test_readers_that_stall_hold_up_nothing():
    assert stalled_reader_row(0.5).broken == ()
