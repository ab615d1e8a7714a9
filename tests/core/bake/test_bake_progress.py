"""Progress that is true: it never falls, ends at one, and leads to a fair time that remains."""

import io
import itertools
import json
import time

import numpy as np
import pytest
import trimesh

from palpate.core.bake.child import ProgressLines
from palpate.core.bake.foreseen_share import ForeseenShare, foreseen
from palpate.core.bake.job import BakeJob
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.bake.work import BakeWork
from palpate.core.machine.remaining_time import RemainingTime
from palpate.core.mesh.surface import Surface
from palpate.core.stiffness.pins import PinNodes


class Heard(list):
    def tell(self, step, share):
        self.append((step, share))

    @property
    def shares(self):
        return [share for _, share in self if share is not None]


def test_steps_count_by_the_time_they_take():
    heard = Heard()
    work = BakeWork(heard.tell)
    work.unknown("tetrahedralize")
    work.expect({"check": 1.0, "compliance": 6.0}, spent=3.0)
    work.begin("check")
    within = work.begin("compliance")
    within(0.5)
    within(1.0)
    assert heard == [
        ("tetrahedralize", None),
        ("check", 0.3),
        ("compliance", 0.4),
        ("compliance", 0.7),
        ("compliance", 1.0),
    ]


def test_a_step_that_turns_out_longer_holds_the_share_and_never_turns_it_back():
    heard = Heard()
    work = BakeWork(heard.tell)
    work.expect({"plan": 5.0, "compliance": 5.0})
    work.begin("plan")
    work.within(1.0)
    work.expect({"compliance": 45.0})
    within = work.begin("compliance")
    for share in np.linspace(0, 1, 11):
        within(share)
    assert heard.shares == sorted(heard.shares)
    assert heard.shares[2] == 0.5
    assert heard.shares[-1] == 1.0


def test_a_step_that_is_not_needed_leaves_no_gap():
    heard = Heard()
    work = BakeWork(heard.tell)
    work.expect({"compliance": 5.0, "compress": 5.0})
    work.forget("compress")
    work.begin("compliance")(1.0)
    assert heard.shares == [0.0, 1.0]


@pytest.mark.parametrize("form", ["dense", "compressed"])
def test_a_bake_from_tetrahedra_knows_its_share_from_the_start(mouse, form):
    heard = Heard()
    settings = BakeSettings(pins=PinNodes(mouse.fixed), form=form)
    bake(mouse.mesh, settings, heard.tell)
    assert len(heard.shares) == len(heard) > 20
    assert heard.shares == sorted(heard.shares)
    assert heard.shares[-1] == 1.0
    steps = list(dict.fromkeys(step for step, _ in heard))
    assert steps == ["stiffness", "plan", "compliance", *(["compress"] * (form == "compressed"))]


@pytest.mark.parametrize("form", ["dense", "compressed"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
def test_whoever_listens_can_cancel_at_any_share(mouse, form, share):
    def stop(_, done):
        if done >= share:
            raise KeyboardInterrupt

    settings = BakeSettings(pins=PinNodes(mouse.fixed), form=form)
    with pytest.raises(KeyboardInterrupt):
        bake(mouse.mesh, settings, stop)


def test_remaining_time_waits_for_something_to_go_by():
    remaining = RemainingTime()
    assert remaining.update(1.0, None) is None
    assert remaining.update(2.0, 0.1) is None
    assert remaining.update(2.2, 0.2) is None
    assert remaining.update(3.0, 0.3) == pytest.approx(3.5)


def test_remaining_time_of_even_work_is_right_throughout():
    remaining = RemainingTime()
    for seconds in np.arange(0, 20, 0.25):
        told = remaining.update(seconds, seconds / 20)
        assert told is None if seconds < 0.5 else told == pytest.approx(20 - seconds)


def test_remaining_time_counts_down_while_the_share_stands_still():
    remaining = RemainingTime()
    remaining.update(0.0, 0.0)
    first = remaining.update(2.0, 0.5)
    assert remaining.update(3.0, 0.5) == pytest.approx(first - 1.0)
    assert remaining.update(60.0, 0.5) == 0.0


def told_of(share, until):
    remaining = RemainingTime()
    return [remaining.update(seconds, share(seconds)) for seconds in np.arange(0.0, until, 0.5)]


def rises(told):
    """Whether what is told ever rises, but after nothing was told."""
    pairs = itertools.pairwise(told)
    return any(one is not None and other is not None and other > one for one, other in pairs)


def test_remaining_time_of_work_that_gets_much_slower_is_unknown_before_it_is_right_again():
    told = told_of(lambda s: 0.1 * s if s < 5 else min(1.0, 0.5 + 0.01 * (s - 5)), 55.0)
    assert not rises(told)
    late = told.index(None, 4)
    assert 5.0 < 0.5 * late < 25.0
    assert told[-1] == pytest.approx(0.5, abs=2.5)
    assert all(one is not None for one in told[-8:])


def test_remaining_time_stands_still_while_the_work_is_a_little_slower():
    told = told_of(lambda s: 0.05 * s if s < 10 else min(1.0, 0.5 + 0.04 * (s - 10)), 22.0)
    assert not rises(told)
    assert None not in told[2:]
    assert told[-1] == pytest.approx(0.5, abs=2.0)


def test_remaining_time_that_the_last_of_a_foreseen_step_drags_out_never_rises():
    told = told_of(lambda s: 0.9 * foreseen(s / 6.0), 60.0)
    assert not rises(told)
    assert all(one is None or one > 0.0 for one in told)


def test_progress_lines_are_few(monkeypatch):
    clock = iter(np.arange(0, 100, 0.001).tolist())
    monkeypatch.setattr("palpate.core.bake.child.time.monotonic", lambda: next(clock))
    lines = io.StringIO()
    add = ProgressLines(lines).add
    for share in np.linspace(0, 1, 1000):
        add("compliance", float(share))
    add("store", 1.0)
    written = [json.loads(line) for line in lines.getvalue().splitlines()]
    assert len(written) < 30
    assert written[0] == ["compliance", 0.0]
    assert written[-1] == ["store", 1.0]


def test_a_step_that_reports_nothing_is_foreseen_and_moves_at_every_look():
    foreseen = ForeseenShare()
    shares = [foreseen.update(now, 0.5, 10.0) for now in np.arange(100.0, 200.0, 0.5)]
    assert shares[0] == 0.0
    assert np.all(np.diff(shares) > 0.0)
    assert shares[20] == pytest.approx(0.4)
    assert shares[-1] < 0.5


def test_a_surface_has_a_share_before_there_are_tetrahedra(ball):
    heard, ahead = Heard(), []
    settings = BakeSettings(edge_length=0.15, epsilon=0.01)
    bake(ball, settings, heard.tell, foresee=lambda *told: ahead.append((len(heard), *told)))
    ((count, step, until, seconds),) = ahead
    assert step == "tetrahedralize"
    assert heard[:count] == [(step, None)]
    assert 0.0 < until < 1.0
    assert seconds > 0.0
    assert heard.shares == sorted(heard.shares)
    assert heard.shares[-1] == 1.0


@pytest.mark.at_length
def test_the_bar_moves_while_tetrahedra_are_made(ball):
    """What a window shows of a child process, looked at ten times a second."""
    shares = []
    with BakeJob(ball, BakeSettings(edge_length=0.03)) as job:
        while not job.finished:
            progress = job.poll()
            if progress.step == "tetrahedralize" and progress.share is not None:
                shares.append(progress.share)
            time.sleep(0.02)
    assert len(shares) > 3
    assert np.all(np.diff(shares) > 0.0)


@pytest.fixture
def ball():
    made = trimesh.creation.icosphere(subdivisions=3, radius=0.05)
    return Surface.checked(made.vertices, made.faces)
