"""A compliance that would give energy is refused, wherever it hides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError
from palpate.core.compliance import definite
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.definite import refuse_indefinite
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.errors import PalpateError


def matrix(compliance):
    columns = compliance.columns(np.arange(compliance.node_count))
    return 0.5 * (columns + columns.T)


def of_matrix(free_surface, matrix):
    count = len(free_surface)
    return DenseCompliance(free_surface, matrix.T.reshape(count, 3, -1).astype(np.float32))


@pytest.fixture(scope="module")
def spectrum(mouse):
    return np.linalg.eigh(matrix(mouse.compliance))


def test_real_bodies_pass(cube, mouse):
    refuse_indefinite(cube.compliance)
    refuse_indefinite(mouse.compliance)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-3, 5e-2])
def test_compressed_ones_pass(mouse, tolerance):
    positions = mouse.mesh.nodes[mouse.compliance.free_surface]
    refuse_indefinite(compress(mouse.compliance, positions, tolerance))


@pytest.mark.parametrize("together", [500, 100_000], ids=["by lot and Lanczos", "by Cholesky"])
@pytest.mark.parametrize(
    "place",
    [0.0, 0.5, 1.0, *(pytest.param(one, marks=pytest.mark.at_length) for one in (0.1, 0.9, 0.99))],
)
@pytest.mark.parametrize("share", [-0.01, -0.1, pytest.param(-1.0, marks=pytest.mark.at_length)])
def test_a_hidden_negative_eigenvalue_is_found(
    mouse, spectrum, monkeypatch, place, share, together
):
    monkeypatch.setattr(definite, "NODES_TOGETHER", together)
    values, vectors = spectrum
    which = int(place * (len(values) - 1))
    one = vectors[:, which]
    hidden = matrix(mouse.compliance) + np.outer(one, one) * (share * values[-1] - values[which])
    with pytest.raises(PalpateError, match="energy"):
        refuse_indefinite(of_matrix(mouse.compliance.free_surface, hidden))


def test_a_negative_direction_of_any_kind_is_found(mouse, spectrum, rng):
    values, _ = spectrum
    for _ in range(5):
        one = rng.standard_normal(len(values))
        one /= np.linalg.norm(one)
        bent = matrix(mouse.compliance)
        # Without the direction, and with a hundredth of the largest eigenvalue against it.
        bent -= (
            np.outer(bent @ one, one)
            + np.outer(one, bent @ one)
            - (one @ bent @ one - 0.01 * values[-1]) * np.outer(one, one)
        )
        with pytest.raises(PalpateError, match="energy"):
            refuse_indefinite(of_matrix(mouse.compliance.free_surface, bent))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", [(3, 1, 9 + 1), (3, 1, 40)], ids=["own", "other"])
def test_numbers_that_are_not_finite_are_found(cube, bad, place):
    table = cube.compliance.table.copy()
    table[place] = bad
    with pytest.raises(PalpateError, match="finite"):
        refuse_indefinite(replace(cube.compliance, table=table))


@pytest.mark.parametrize("change", ["negative diagonal", "turned around", "not symmetric"])
def test_other_faults_are_found(cube, change):
    table = cube.compliance.table.copy()
    if change == "negative diagonal":
        table[5, 2, 3 * 5 + 2] *= -1.0
    elif change == "turned around":
        table *= -1.0
    else:
        table[5, 2, 90:120] *= 1.5
    with pytest.raises(PalpateError, match=r"energy|symmetric"):
        refuse_indefinite(replace(cube.compliance, table=table))


@pytest.mark.parametrize("mapped_from", [None, 0], ids=["read", "mapped"])
def test_a_body_file_with_right_checksums_is_refused_all_the_same(cube, tmp_path, mapped_from):
    values, vectors = np.linalg.eigh(matrix(cube.compliance))
    one = vectors[:, 70]
    hidden = matrix(cube.compliance) - np.outer(one, one) * (values[70] + 0.01 * values[-1])
    bent = of_matrix(cube.compliance.free_surface, hidden)
    body_file.save(replace(cube, compliance=bent), tmp_path / "cube.npz")
    with pytest.raises(BodyFileError, match=r"cube\.npz.*energy.*bake again"):
        body_file.load(tmp_path / "cube.npz", mapped_from_bytes=mapped_from)


def test_so_are_a_compressed_bodys_own_blocks(mouse, tmp_path):
    positions = mouse.mesh.nodes[mouse.compliance.free_surface]
    compressed = compress(mouse.compliance, positions, 1e-3)
    blocks = compressed.own_blocks.copy()
    blocks[7] *= -1.0
    body_file.save(
        replace(mouse, compliance=replace(compressed, own_blocks=blocks)), tmp_path / "m.npz"
    )
    with pytest.raises(BodyFileError, match="energy"):
        body_file.load(tmp_path / "m.npz")
