"""The firmware beside hosts that are stopped or end with their guardian, and behind slow lines."""

import sys
from functools import partial

import pytest

from palpate.simulated.attack.real.firmware import FirmwareBoard, slow_row
from palpate.simulated.attack.real.host import Host
from palpate.simulated.attack.real.lost_guardians import leave_alone
from palpate.simulated.attack.real.processes import device_problems, kill, suspend
from palpate.simulated.attack.target import ABOVE

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")


@pytest.fixture
def board(board_program):
    return partial(FirmwareBoard, board_program, ABOVE)


def test_its_own_watchdog_ends_a_force_that_was_the_last_word(board):
    with board() as hand:
        report = kill(hand.port, hand, leave_alone)
    assert device_problems(report) == []
    assert report["largest_force"] > 0.3


def test_it_is_let_go_while_its_host_is_stopped_and_pushed_again_by_the_ramp(board):
    with board() as hand, Host(hand.port) as host:
        assert suspend(host, hand).problems() == []


@pytest.mark.parametrize("baud", [9_600, 19_200])
def test_behind_a_line_that_is_too_slow_it_is_never_pushed(board, baud):
    row = slow_row(board, baud, 1, "slow")
    assert (row.broken, row.felt) == ((), 0.0)
    assert row.told in ("deaf", "stale")
