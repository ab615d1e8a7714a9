"""``palpate bake --output-folder``, on this computer and on a cluster of two worker processes."""

import contextlib
import gc
import importlib.metadata
import json
import logging
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import trimesh

from palpate.cli.bake import scheduler
from palpate.core.body import body_file
from palpate.core.machine.available_cores import available_cores


@pytest.fixture
def meshes(tmp_path, monkeypatch, cube_mesh):
    """Two that become bodies, and one that does not."""
    monkeypatch.chdir(tmp_path)
    mesh, fixed = cube_mesh
    np.savez("cube.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed)
    np.savez("large.npz", X=2 * mesh.nodes, T=mesh.tets, fixed=fixed)
    Path("broken.obj").write_text("# nothing\n")
    return ["cube.npz", "broken.obj", "large.npz"]


@pytest.fixture
def long_meshes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    trimesh.creation.icosphere(subdivisions=4).export("ball.stl")
    Path("second.stl").write_bytes(Path("ball.stl").read_bytes())
    return ["ball.stl", "second.stl"]


@pytest.fixture(scope="module")
def start_cluster():
    pytest.importorskip("distributed", reason="distributed is not installed (extra 'scheduler')")
    from distributed import LocalCluster

    with contextlib.ExitStack() as clusters:

        def start(**options):
            return clusters.enter_context(
                LocalCluster(
                    threads_per_worker=1,
                    host="127.0.0.1",
                    dashboard_address="127.0.0.1:0",
                    silence_logs=logging.CRITICAL,
                    **options,
                )
            )

        yield start


@pytest.fixture(scope="module")
def workers_scratch(tmp_path_factory):
    """Where the two workers put what they need for a while."""
    return tmp_path_factory.mktemp("workers")


@pytest.fixture(scope="module")
def two_workers(start_cluster, workers_scratch):
    environment = {"TMPDIR": str(workers_scratch)}
    return start_cluster(n_workers=2, processes=True, env=environment).scheduler_address


def names_in(folder):
    return sorted(path.name for path in Path(folder).iterdir())


def assert_two_of_three_became_bodies(status, printed, said):
    assert status == 2
    assert len(said.splitlines()) == 1
    assert said.startswith("palpate: broken.obj: mesh: it has 0 vertices and 0 faces")
    told = {entry["mesh"]: entry for entry in json.loads(printed)["bodies"]}
    assert set(told) == {"cube.npz", "broken.obj", "large.npz"}
    assert told["cube.npz"]["free_surface_nodes"] == 73
    assert told["broken.obj"] == {
        "mesh": "broken.obj",
        "error": said.strip().removeprefix("palpate: broken.obj: "),
    }
    assert names_in("bodies") == ["cube.npz", "large.npz"]
    assert body_file.load("bodies/large.npz").mesh.volume == pytest.approx(0.1**3)


def test_many_meshes_become_bodies_in_a_folder(meshes, palpate):
    assert_two_of_three_became_bodies(
        *palpate("bake", *meshes, "--output-folder", "bodies", "--jobs", 2, "--json")
    )


def test_lines_say_what_became_of_each(meshes, palpate):
    status, printed, _ = palpate("bake", "cube.npz", "--output-folder", "bodies")
    assert status == 0
    place = Path("bodies/cube.npz")
    assert printed.startswith(f"cube.npz -> {place}  125 nodes, 73 free on the surface, ")


@pytest.mark.at_length
def test_a_cluster_bakes_as_this_computer_does(meshes, palpate, two_workers):
    words = ["--output-folder", "bodies", "--scheduler", two_workers, "--json"]
    assert_two_of_three_became_bodies(*palpate("bake", *meshes, *words))


@pytest.mark.skipif(sys.platform == "win32", reason="signals are of Unix")
@pytest.mark.parametrize(
    "workers", ["threads", pytest.param("cluster", marks=pytest.mark.at_length)]
)
def test_an_interrupt_ends_all_bakes(long_meshes, workers, request, tmp_path):
    where = ["--jobs", "2"]
    scratch = tmp_path / "scratch"
    if workers == "cluster":
        where = ["--scheduler", request.getfixturevalue("two_workers")]
        scratch = request.getfixturevalue("workers_scratch")
    scratch.mkdir(exist_ok=True)
    words = ["bake", *long_meshes, "--output-folder", "bodies", "--edge-length", "0.01", *where]
    with subprocess.Popen(
        [sys.executable, "-m", "palpate.cli.main", *words],
        env=os.environ | {"TMPDIR": str(scratch)},
        stderr=subprocess.PIPE,
        text=True,
    ) as program:
        while len(list(scratch.glob("palpate-bake-*/progress.jsonl"))) < 2:
            assert program.poll() is None
            time.sleep(0.05)
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=30)
    # How long it would take is said before.
    assert (program.returncode, said.splitlines()[-1]) == (130, "palpate: stopped")
    assert "Traceback" not in said
    assert names_in("bodies") == []
    deadline = time.monotonic() + 20
    while list(scratch.glob("palpate-*")):
        assert time.monotonic() < deadline, "the workers go on"
        time.sleep(0.05)


def test_a_cluster_that_cannot_be_used_gets_one_line(meshes, refusal, start_cluster, monkeypatch):
    monkeypatch.setattr(scheduler, "CONNECT_SECONDS", 1)

    def refused(address):
        words = ["cube.npz", "--output-folder", "bodies", "--scheduler", address]
        said = refusal("bake", *words)
        # Dask's client that came to nothing is closed where it is collected: in the starting thread
        # of the next one, the two would wait for each other.
        gc.collect()
        return said

    assert "nothing answers at tcp://127.0.0.1:9" in refused("tcp://127.0.0.1:9")
    assert "nothing answers at nonsense://x" in refused("nonsense://x")
    assert "has no workers" in refused(start_cluster(n_workers=0).scheduler_address)
    bare = start_cluster(n_workers=1, preload="import sys; sys.modules['palpate'] = None")
    assert "cannot load Palpate" in refused(bare.scheduler_address)


def test_a_cluster_with_another_palpate_is_refused(meshes, refusal, two_workers, monkeypatch):
    here = importlib.metadata.version
    monkeypatch.setattr(importlib.metadata, "version", lambda name: f"{here(name)}.1")
    words = ["cube.npz", "--output-folder", "bodies", "--scheduler", two_workers]
    said = refusal("bake", *words)
    assert f"has palpate {here('palpate')}, and this is {here('palpate')}.1; install" in said


def test_a_cluster_learns_that_nobody_waits_any_more(two_workers):
    found = []

    def interrupted():
        with scheduler.cluster(two_workers) as workers:
            found.append(workers)
            assert workers.count == 2
            assert workers.executor.submit(workers.wanted).result() is True
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    with scheduler.cluster(two_workers) as later:
        assert later.executor.submit(later.wanted).result() is True
        assert later.executor.submit(found[0].wanted).result() is False


def test_without_dask_one_line_says_what_to_install(meshes, refusal, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    words = ["cube.npz", "--output-folder", "bodies", "--scheduler", "tcp://farm:8786"]
    assert "pip install palpate[scheduler]" in refusal("bake", *words)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["cube.npz", "large.npz", "-o", "out.npz"], "--output-folder"),
        (["cube.npz", "-o", "out.npz", "--jobs", "2"], "--jobs: is for baking many meshes"),
        (["cube.npz", "--predict", "--jobs", "2"], "--jobs: is for baking many meshes"),
        (["cube.npz", "cube.stl", "--output-folder", "bodies"], "rename one"),
        (["cube.npz", "--output-folder", "."], "take its place"),
        (["cube.npz", "--output-folder", "broken.obj"], "broken.obj is a file; name a folder"),
        (["cube.npz", "--output-folder", "bodies", "--jobs", "0"], "--jobs"),
    ],
)
def test_what_cannot_be_is_refused_before_any_work(meshes, refusal, words, said):
    assert said in refusal("bake", *words)
    assert names_in(".") == ["broken.obj", "cube.npz", "large.npz"]


def test_cores_are_those_this_process_may_use():
    assert 1 <= available_cores() <= (os.cpu_count() or 1)


@pytest.mark.parametrize("contents", ["no json", "[1]", "{}", '"text"'])
def test_a_file_that_is_no_schedulers_is_refused_in_one_line(meshes, refusal, contents):
    pytest.importorskip("distributed", reason="distributed is not installed (extra 'scheduler')")
    Path("scheduler.json").write_text(contents, encoding="utf-8")
    words = ["cube.npz", "--output-folder", "bodies", "--scheduler", "scheduler.json"]
    assert "scheduler.json is no scheduler file" in refusal("bake", *words)


@pytest.mark.parametrize("fraction", ["nan", "-0.1", "1.5"])
def test_pins_that_no_bake_would_take_are_not_predicted(meshes, refusal, fraction):
    words = ["cube.npz", "--predict", "--pin-below", fraction]
    assert "must lie between 0" in refusal("bake", *words)


@pytest.mark.parametrize(
    ("address", "is_open"),
    [
        ("tcp://127.0.0.1:8786", False),
        ("tcp://localhost:8786", False),
        ("tcp://[::1]:8786", False),
        ("tls://farm:8786", False),
        ("inproc://192.168.1.9/12/1", False),
        ("tcp://192.168.1.9:8786", True),
        ("tcp://0.0.0.0:8786", True),
        ("tcp://[::]:8786", True),
        ("tcp://farm:8786", True),
        ("farm:8786", True),
    ],
)
def test_a_scheduler_that_a_network_reaches_is_known(address, is_open):
    assert scheduler.is_open(address) == is_open


@pytest.mark.at_length
def test_an_open_scheduler_is_told_once(meshes, palpate, start_cluster):
    """It listens on all interfaces, though it is reached by the loopback."""
    everywhere = start_cluster(n_workers=1, scheduler_kwargs={"host": "tcp://0.0.0.0:0"})
    port = everywhere.scheduler_address.rpartition(":")[2]
    words = ["--output-folder", "bodies", "--scheduler", f"tcp://127.0.0.1:{port}"]
    status, _, said = palpate("bake", "cube.npz", *words)
    assert status == 0
    assert said.count("can be reached from the network") == 1
