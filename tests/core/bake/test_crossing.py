"""Length along which a surface passes through itself, against what is known."""

import numpy as np
import pytest

from palpate.core.bake.cost.crossing import MOST_TRIANGLES, crossing_length
from palpate.core.mesh.surface import Surface

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def together(*squares):
    vertices = np.concatenate(squares)
    triangles = np.concatenate([HALVES + 4 * number for number in range(len(squares))])
    return Surface(vertices, triangles)


def upright(x, share=1.0):
    """A square across the first, of which a ``share`` of the width is within it."""
    return SQUARE[:, [2, 1, 0]] + [x, 1.0 - share, -0.31]


@pytest.mark.parametrize("share", [1.0, 0.43])
def test_two_squares_cross_along_what_they_share(share, rng):
    surface = together(SQUARE, upright(0.37, share))
    assert crossing_length(surface) == pytest.approx(share)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turned = Surface(5.0 * surface.vertices @ turn + 2.0, surface.triangles)
    assert crossing_length(turned) == pytest.approx(5.0 * share)


def test_what_only_touches_or_lies_beside_does_not_cross():
    folded = Surface(
        np.concatenate([SQUARE, SQUARE[[0, 1]] + np.array([0.0, 0.0, 1.0])]),
        np.concatenate([HALVES, [[0, 1, 4], [1, 5, 4]]]),
    )
    assert crossing_length(folded) == 0.0
    # Also where each triangle has corners of its own.
    split = Surface(folded.vertices[folded.triangles].reshape(-1, 3), np.arange(12).reshape(-1, 3))
    assert crossing_length(split) == 0.0
    assert (
        crossing_length(together(SQUARE, SQUARE + np.array([0.0, 0.0, 0.2]), upright(1.4))) == 0.0
    )


def test_all_pairs_are_looked_at_however_many_there_are(monkeypatch):
    squares = [SQUARE, *(upright(x) for x in np.linspace(0.11, 0.93, 30))]
    expected = crossing_length(together(*squares))
    assert expected == pytest.approx(30.0)
    monkeypatch.setattr("palpate.core.bake.cost.crossing.PAIRS_AT_ONCE", 7)
    assert crossing_length(together(*squares)) == pytest.approx(expected)


def test_very_many_triangles_are_not_looked_at():
    many = np.tile(HALVES, (MOST_TRIANGLES // 2, 1))
    crossed = Surface(np.concatenate([SQUARE, upright(0.37)]), np.concatenate([HALVES, 4 + HALVES]))
    assert crossing_length(crossed) > 0.9
    assert (
        crossing_length(Surface(crossed.vertices, np.concatenate([crossed.triangles, many]))) == 0.0
    )
