"""A table compressed by worker processes is the one that a single process makes."""

import multiprocessing
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

from palpate.core.compliance.compression.clusters_on_workers import clusters_on, store
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.elimination.surface_columns import factor_for_columns
from palpate.core.stiffness.assembly import assemble

TOLERANCE = 3e-3


@pytest.fixture(scope="module")
def columns(mouse_mesh):
    mesh, fixed = mouse_mesh
    return factor_for_columns(mesh, assemble(mesh, 0.3), fixed)


@pytest.mark.parametrize("is_free", [False, True])
def test_stored_columns_are_the_same(is_free, columns, mouse_mesh, tmp_path, rng):
    if is_free:
        mesh, _ = mouse_mesh
        columns = factor_for_columns(mesh, assemble(mesh, 0.3), np.empty(0, dtype=np.int64))
    stored = store(columns, tmp_path)
    nodes = rng.choice(columns.node_count, 20, replace=False)
    assert stored.node_count == columns.node_count
    np.testing.assert_array_equal(stored.free_surface, columns.free_surface)
    np.testing.assert_allclose(
        stored.columns(nodes), columns.columns(nodes), rtol=1e-12, atol=1e-18
    )
    np.testing.assert_allclose(stored.diagonal(), columns.diagonal(), rtol=1e-12, atol=1e-18)


@pytest.mark.at_length
def test_worker_processes_compress_what_one_process_does(columns, mouse_mesh, tmp_path):
    positions = mouse_mesh[0].nodes[columns.free_surface]
    here = compress(columns, positions, TOLERANCE)
    spawned = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=spawned) as processes:
        with clusters_on(processes, columns, tmp_path) as map_clusters:
            there = compress(columns, positions, TOLERANCE, map_clusters=map_clusters)
        assert list(tmp_path.iterdir()) == []
    exact = columns.columns(np.arange(0, columns.node_count, 10))
    for compressed in (here, there):
        off = compressed.columns(np.arange(0, columns.node_count, 10)) - exact
        error = np.linalg.norm(off, axis=0) / np.linalg.norm(exact, axis=0)
        assert error.max() < TOLERANCE
    assert there.nbytes == pytest.approx(here.nbytes, rel=0.02)


def test_a_pass_that_is_stopped_leaves_no_files(columns, mouse_mesh, tmp_path):
    def stop(_share):
        raise KeyboardInterrupt

    positions = mouse_mesh[0].nodes[columns.free_surface]
    spawned = multiprocessing.get_context("spawn")
    with (
        ProcessPoolExecutor(1, mp_context=spawned) as processes,
        pytest.raises(KeyboardInterrupt),
        clusters_on(processes, columns, tmp_path) as map_clusters,
    ):
        compress(columns, positions, TOLERANCE, stop, map_clusters)
    assert list(tmp_path.iterdir()) == []
