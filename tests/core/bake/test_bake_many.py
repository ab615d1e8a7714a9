"""Many bodies through executors: each mesh on its own, whatever the workers are."""

import dataclasses
import multiprocessing
import tempfile
import threading
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
import trimesh

from palpate.core.bake.lease import Lease, lease
from palpate.core.bake.many import BakeTask, bake_many
from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body import body_file
from palpate.core.files.atomic_file import UnwritableError
from palpate.core.mesh.surface import Surface
from palpate.core.stiffness.pins import PinNodes


@pytest.fixture
def cube_task(cube_mesh):
    mesh, fixed = cube_mesh
    settings = BakeSettings(0.49, 10_000.0, PinNodes(fixed))
    return BakeTask("cube", "cube.npz", mesh, settings)


@pytest.fixture
def loose_task(cube_task):
    settings = dataclasses.replace(cube_task.settings, pins=PinNodes(np.array([0, 1])))
    return dataclasses.replace(cube_task, name="loose", file_name="loose.npz", settings=settings)


@pytest.fixture
def endless_task():
    ball = trimesh.creation.icosphere(subdivisions=4)
    surface = Surface.checked(ball.vertices, ball.faces)
    return BakeTask("ball", "ball.npz", surface, BakeSettings(edge_length=0.01))


@pytest.fixture
def scratch(tmp_path, monkeypatch):
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


class Elsewhere(ThreadPoolExecutor):
    """Workers that do not reach the folder of the results."""

    def submit(self, function, task, folder, sign, *others):
        hidden = Lease(sign.path.with_name("not here"), sign.word)
        return super().submit(function, task, folder / "not here", hidden, *others)


def never():
    return False


def test_one_mesh_that_fails_does_not_stop_the_others(tmp_path, cube_task, loose_task):
    told = []
    with ThreadPoolExecutor(2) as threads:
        outcomes = bake_many(
            [loose_task, cube_task], tmp_path / "bodies", threads, on_done=told.append
        )
    assert told == outcomes
    by_name = {outcome.name: outcome for outcome in outcomes}
    assert set(by_name) == {"cube", "loose"}
    assert "pins: the body is pinned at 2 nodes" in by_name["loose"].error
    assert by_name["loose"].path is None
    cube = by_name["cube"]
    assert (cube.error, cube.nodes, cube.free_surface_nodes, cube.form) == (None, 125, 73, "dense")
    assert [path.name for path in (tmp_path / "bodies").iterdir()] == ["cube.npz"]
    there = body_file.load(cube.path)
    here, _ = bake(cube_task.source, cube_task.settings)
    every = np.arange(73)
    np.testing.assert_array_equal(there.compliance.columns(every), here.compliance.columns(every))


def test_processes_bake_as_threads_do(tmp_path, cube_task):
    spawned = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawned) as processes:
        (outcome,) = bake_many([cube_task], tmp_path, processes)
    assert outcome.error is None
    assert body_file.load(outcome.path).compliance.node_count == 73


def test_workers_without_the_folder_hand_the_file_back(tmp_path, cube_task, loose_task, scratch):
    with Elsewhere(2) as workers:
        outcomes = bake_many([cube_task, loose_task], tmp_path / "bodies", workers)
    assert sorted(outcome.error is None for outcome in outcomes) == [False, True]
    assert body_file.load(tmp_path / "bodies" / "cube.npz").compliance.node_count == 73
    assert list(scratch.iterdir()) == []


def test_workers_without_the_folder_stop_when_told_otherwise(tmp_path, endless_task, scratch):
    with Elsewhere(1) as workers:
        (outcome,) = bake_many([endless_task], tmp_path, workers, wanted=never)
    assert "nobody waits" in outcome.error
    assert list(scratch.iterdir()) == []


@pytest.mark.parametrize("workers", [ThreadPoolExecutor, Elsewhere])
def test_an_interrupt_stops_all_bakes_and_leaves_nothing(tmp_path, endless_task, scratch, workers):
    folder = tmp_path / "bodies"
    interrupted = threading.Event()

    def interrupt(_running):
        if len(list(scratch.glob("palpate-bake-*/progress.jsonl"))) == 2:
            interrupted.set()
            raise KeyboardInterrupt

    second = dataclasses.replace(endless_task, name="second", file_name="second.npz")
    third = dataclasses.replace(endless_task, name="third", file_name="third.npz")
    with workers(2) as pool, pytest.raises(KeyboardInterrupt):
        bake_many(
            [endless_task, second, third],
            folder,
            pool,
            on_wait=interrupt,
            wanted=lambda: not interrupted.is_set(),
        )
    assert list(folder.iterdir()) == []
    assert list(scratch.iterdir()) == []


def test_tasks_are_taken_when_there_is_room(tmp_path, loose_task):
    most = 0

    def tasks():
        for number in range(3):
            nonlocal most
            most = max(most, number + 1 - len(done))
            yield dataclasses.replace(loose_task, name=str(number))

    done = []
    with ThreadPoolExecutor(2) as threads:
        bake_many(tasks(), tmp_path, threads, on_done=done.append, at_once=2)
    assert sorted(outcome.name for outcome in done) == list("012")
    assert most == 2


class Broken(ThreadPoolExecutor):
    """Workers that died; the second time they are asked, they say so at once."""

    asked = 0

    def submit(self, *_):
        self.asked += 1
        if self.asked > 1:
            raise BrokenExecutor("no worker is left")
        return super().submit(lambda: 1 / 0)


def test_a_worker_that_fails_is_told_for_each_mesh(tmp_path, cube_task):
    with Broken(1) as workers:
        outcomes = bake_many([cube_task, cube_task], tmp_path, workers)
    said = sorted(outcome.error for outcome in outcomes)
    assert len(said) == 2
    assert said[0].startswith("the worker failed (BrokenExecutor: no worker is left); bake this")
    assert said[1].startswith("the worker failed (ZeroDivisionError: division by zero); bake this")


def test_a_folder_that_cannot_be_is_refused_before_any_work(tmp_path, cube_task):
    (tmp_path / "file").write_text("")
    with ThreadPoolExecutor(1) as threads, pytest.raises(UnwritableError, match="file"):
        bake_many([cube_task], tmp_path / "file" / "bodies", threads)


def test_a_lease_is_known_by_its_word_and_ends(tmp_path):
    with lease(tmp_path) as sign:
        assert sign.is_seen()
        assert not dataclasses.replace(sign, word="another machine's").is_seen()
    assert not sign.is_seen()
    assert list(tmp_path.iterdir()) == []
