"""The shapes that can be drawn: names, what all of them have in common."""

import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.shape.shapes import EXPLANATIONS, MAKERS, SERIES_IS_PAPER, SHAPES, shape

EDGE = 0.05


@pytest.fixture(params=list(MAKERS))
def made(request, cube):
    made = shape(cube, request.param)
    yield made
    made.close()


def load(cube, size):
    """The middle of the top, pressed down by ``size`` newton."""
    middle = np.argmin(np.linalg.norm(cube.mesh.nodes - [EDGE / 2, EDGE / 2, EDGE], axis=1))
    return np.array([middle]), np.array([[0.0, 0.0, -size]])


def test_every_name_is_explained_in_a_line():
    assert list(EXPLANATIONS) == list(SHAPES)
    assert all(len(text) < 90 for text in EXPLANATIONS.values())


def test_an_unknown_name_is_refused_with_those_there_are(cube):
    with pytest.raises(PalpateError, match=r"'round' is unknown; give linear, .* or real"):
        shape(cube, "round")


@pytest.mark.parametrize("former", ["table", "series"])
def test_former_names_mean_paper_and_series_says_so(cube, former):
    made = shape(cube, former)
    made.close()
    assert type(made) is MAKERS["paper"]
    assert (made.notice == SERIES_IS_PAPER) == (former == "series")


def test_small_forces_give_the_linear_shape(made, cube):
    nodes, forces = load(cube, 1e-6)
    made.wait_for(nodes)
    assert made.ready == 1.0
    linear = cube.deform(nodes, forces)
    error = np.linalg.norm(made.displacements(nodes, forces) - linear)
    assert error < 1e-4 * np.linalg.norm(linear)


def test_youngs_modulus_scales_the_force(made, cube):
    nodes, forces = load(cube, 0.5)
    made.wait_for(nodes)
    np.testing.assert_allclose(
        made.displacements(nodes, 3 * forces, 3 * cube.young_modulus),
        made.displacements(nodes, forces, cube.young_modulus),
        rtol=1e-9,
        atol=1e-12,
    )


def test_no_force_and_forces_on_pinned_nodes_move_nothing(made, cube):
    nodes = np.array([*load(cube, 1.0)[0], cube.fixed[0]])
    forces = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    made.wait_for(nodes)
    assert not made.displacements(nodes, forces).any()
