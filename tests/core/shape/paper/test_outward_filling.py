"""Filling in the background: what is touched first, then outward, until it is told to end."""

import threading

import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.shape.paper.outward_filling import OutwardFilling

COUNT = 30
POSITIONS = np.stack([np.arange(COUNT), np.zeros(COUNT), np.zeros(COUNT)], axis=1).astype(float)


class Recorder:
    """A table that remembers in which order it was filled."""

    def __init__(self):
        self.is_filled = np.zeros(COUNT, dtype=bool)
        self.order = []

    def fill(self, places):
        self.order += places.tolist()
        self.is_filled[places] = True


@pytest.fixture
def table():
    return Recorder()


@pytest.fixture
def filling(table):
    filling = OutwardFilling(POSITIONS, table.is_filled, table.fill, 2)
    yield filling
    filling.close()


def test_what_is_waited_for_comes_first_and_then_what_is_near(table, filling, eventually):
    wanted = np.array([10, 11, 12])
    filling.wait_for(wanted)
    assert table.order[:3] == [10, 11, 12]
    eventually(lambda: len(table.order) == COUNT)
    distances = np.abs(np.array(table.order) - 11)
    assert sorted(table.order) == list(range(COUNT))
    assert (np.diff(distances[3:]) >= 0).all()


def test_frames_do_not_hold_up_the_touched_place(table, filling):
    wanted = np.array([3, 4, 5, 6, 7])
    filled = threading.Event()
    whole = table.fill

    def fill(places):
        whole(places)
        if table.is_filled[wanted].all():
            filled.set()

    filling._fill = fill
    filling.around(wanted)
    assert filled.wait(10)
    assert table.order[:5] == [3, 4, 5, 6, 7]


def test_it_ends_after_the_slice_that_is_under_way(table):
    entered, leave = threading.Event(), threading.Event()

    def fill(places):
        entered.set()
        leave.wait(10)
        table.fill(places)

    filling = OutwardFilling(POSITIONS, table.is_filled, fill, 2)
    filling.around(np.array([0]))
    assert entered.wait(10)
    filling.close(patience=0.01)
    assert not table.is_filled.any()
    closing = threading.Thread(target=filling.close)
    closing.start()
    leave.set()
    closing.join(10)
    assert not closing.is_alive()
    assert table.is_filled.sum() <= 2
    filling.around(np.array([20]))
    filling.close()
    assert not table.is_filled[20]


def test_a_problem_reaches_whoever_waits(table):
    def fill(_):
        raise ValueError("no such entry")

    filling = OutwardFilling(POSITIONS, table.is_filled, fill, 2)
    with pytest.raises(ValueError, match="no such entry"):
        filling.wait_for(np.array([1]))
    assert isinstance(filling.problem, ValueError)
    filling.close()


def test_beyond_the_most_only_what_is_asked_for_is_filled(table, eventually):
    filling = OutwardFilling(POSITIONS, table.is_filled, table.fill, 2, most=6)
    filling.wait_for(np.array([10, 11]))
    eventually(lambda: len(table.order) == 6)
    filling.wait_for(np.array([28, 29]))
    filling.close()
    assert sorted(table.order) == [8, 9, 10, 11, 12, 13, 28, 29]


def test_nothing_begins_before_a_touch(table):
    filling = OutwardFilling(POSITIONS, table.is_filled, table.fill, 2)
    filling.close()
    assert not table.order


def test_whoever_waits_is_told_when_it_is_closed(table):
    begun, may_end = threading.Event(), threading.Event()

    def fill(places):
        begun.set()
        may_end.wait(10)
        table.fill(places)

    filling = OutwardFilling(POSITIONS, table.is_filled, fill, 2)

    def close():
        begun.wait(10)
        filling.close(0.0)
        may_end.set()

    closing = threading.Thread(target=close)
    closing.start()
    with pytest.raises(PalpateError, match="closed meanwhile"):
        filling.wait_for(np.arange(6))
    closing.join()
    filling.close()
    # What was filled is there all the same.
    filling.wait_for(np.flatnonzero(table.is_filled))
