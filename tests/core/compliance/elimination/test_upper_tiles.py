import numpy as np
import pytest

from palpate.core.compliance.elimination.extend_add import extend_add, runs_between
from palpate.core.compliance.elimination.upper_tiles import UpperTiles


def zeros(size, tile):
    """A zero matrix, (size, size), with all its columns."""
    made = UpperTiles(size, tile)
    for _ in made.edges[1:]:
        made.add_column()
    return made


@pytest.mark.parametrize("size", [0, 1, 7, 8, 30])
def test_a_gram_matrix_is_subtracted(rng, size):
    panel = np.asfortranarray(rng.normal(size=(5, size)))
    tiles, flops = zeros(size, 8), []
    tiles.subtract_gram(panel, flops.append)
    np.testing.assert_allclose(tiles.dense(), -panel.T @ panel, atol=1e-14)
    assert sum(flops) == 5 * size**2


@pytest.mark.parametrize("tile", [4, 9, 64])
def test_extend_add_is_addition_by_node_numbers(rng, tile):
    """Against one dense matrix with rows and columns picked entry by entry."""
    pivot_count, boundary, size = 9, 27, 21
    targets = np.sort(rng.choice(pivot_count + boundary, size, replace=False))
    child = zeros(size, tile)
    child.subtract_gram(np.asfortranarray(rng.normal(size=(size, size))), lambda _: None)
    pivots = np.zeros((pivot_count, pivot_count), order="F")
    border = np.zeros((pivot_count, boundary), order="F")
    schur = UpperTiles(boundary, tile)
    runs = runs_between(targets, pivot_count, child.edges, schur.edges)
    expected = np.zeros((pivot_count + boundary,) * 2)
    expected[np.ix_(targets, targets)] = child.dense()
    extend_add([(child, runs)], pivots, border, schur)

    assert not any(child.tiles)
    np.testing.assert_array_equal(np.triu(pivots), np.triu(expected[:pivot_count, :pivot_count]))
    np.testing.assert_array_equal(border, expected[:pivot_count, pivot_count:])
    np.testing.assert_array_equal(schur.dense(), expected[pivot_count:, pivot_count:])


def test_runs_are_as_long_as_they_can_be():
    targets = np.array([2, 3, 4, 7, 8, 9, 10])
    runs = runs_between(targets, 4, (0, 7), (0, 10))
    assert [run.below for run in runs] == [slice(0, 2), slice(2, 3), slice(3, 7)]
    assert [run.parent_tile for run in runs] == [-1, 0, 0]
    assert [run.onward for run in runs] == [slice(2, 4), slice(0, 1), slice(3, 7)]


def test_a_front_without_boundary_has_no_runs():
    nothing = np.zeros(0, dtype=np.int64)
    assert runs_between(nothing, 5, (0,), (0, 3)) == []


def test_children_are_added_together_as_one_after_the_other(rng):
    tile, boundary, pivot_count = 7, 30, 6
    children, targets = [], []
    for size in (18, 25, 0):
        child = zeros(size, tile)
        child.subtract_gram(np.asfortranarray(rng.normal(size=(3, size))), lambda _: None)
        children.append(child)
        targets.append(np.sort(rng.choice(pivot_count + boundary, size, replace=False)))
    expected = np.zeros((pivot_count + boundary,) * 2)
    for child, places in zip(children, targets, strict=True):
        expected[np.ix_(places, places)] += child.dense()
    pivots = np.zeros((pivot_count, pivot_count), order="F")
    border = np.zeros((pivot_count, boundary), order="F")
    schur = UpperTiles(boundary, tile)
    runs = [
        runs_between(places, pivot_count, child.edges, schur.edges)
        for child, places in zip(children, targets, strict=True)
    ]
    extend_add(list(zip(children, runs, strict=True)), pivots, border, schur)
    np.testing.assert_array_equal(np.triu(pivots), np.triu(expected[:pivot_count, :pivot_count]))
    np.testing.assert_array_equal(border, expected[:pivot_count, pivot_count:])
    np.testing.assert_array_equal(schur.dense(), expected[pivot_count:, pivot_count:])
