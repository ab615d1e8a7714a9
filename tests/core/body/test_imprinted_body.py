"""Bodies with imprints are touched where these are, by closed forms."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.body.imprinted_body import DrawnImprint, imprinted
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube

EDGE, RATIO, RADIUS, DEPTH = 0.05, 0.3, 0.01, 0.0005
MIDDLE = np.array([0.5 * EDGE, 0.5 * EDGE, EDGE])


@pytest.fixture(scope="module")
def cube():
    return baked_body(*paper_cube(EDGE, 8), RATIO, 1.0)


def force(body, height, depth=DEPTH):
    """Of a ball that goes into the middle of the top, there at a height, metres."""
    centre = [*MIDDLE[:2], height + RADIUS - depth]
    return press_tool(body, sphere(RADIUS), Pose.at(centre)).force[2]


def on_top(imprint_of, cells=100):
    """Imprint of a fine drawing of the top, by a function of its vertices (p, 3)."""
    steps = np.linspace(0.0, EDGE, cells + 1)
    x, y = (one.ravel() for one in np.meshgrid(steps, steps))
    vertices = np.column_stack([x, y, np.full(len(x), EDGE)])
    first = np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)[None, :]
    i = first.ravel()
    lower, upper = (i, i + 1, i + cells + 1), (i + 1, i + cells + 2, i + cells + 1)
    triangles = np.concatenate([np.column_stack(lower), np.column_stack(upper)])
    return DrawnImprint(vertices, triangles, imprint_of(vertices))


def test_a_body_whose_imprint_is_a_shift_is_felt_there_as_it_was(cube):
    down = np.array([0.0, 0.0, -0.002])
    body = imprinted(cube, on_top(lambda vertices: np.tile(down, (len(vertices), 1))))
    assert force(body, EDGE) == 0.0
    assert force(body, EDGE - 0.002) == pytest.approx(force(cube, EDGE), rel=1e-6)
    assert body.key == cube.key


def test_triangles_without_area_are_left_out(cube):
    drawn = on_top(lambda vertices: np.full_like(vertices, -0.002))
    flat = np.vstack([[[0, 0, 1]], drawn.triangles, [[0, 1, 2]]])
    with_flat = DrawnImprint(drawn.vertices, flat, drawn.moved)
    assert imprinted(cube, with_flat).mesh.nodes == pytest.approx(imprinted(cube, drawn).mesh.nodes)


def test_a_ball_in_a_hollow_is_as_firm_as_hertz_has_it(cube):
    """1 / R = 1 / R_ball - 1 / R_hollow, and the force goes by the root of R."""
    hollow, deep = 2.0 * RADIUS, 0.0015

    def carved(vertices):
        away = np.sum((vertices - MIDDLE)[:, :2] ** 2, axis=1)
        floor = hollow - np.sqrt(np.maximum(hollow**2 - away, 0.0)) - deep
        return np.column_stack([0 * away, 0 * away, np.minimum(floor, 0.0)])

    body = imprinted(cube, on_top(carved))
    assert force(body, EDGE - deep, depth=-0.0001) == 0.0
    ratio = force(body, EDGE - deep) / force(cube, EDGE)
    assert ratio == pytest.approx(np.sqrt(2.0), rel=0.05)
