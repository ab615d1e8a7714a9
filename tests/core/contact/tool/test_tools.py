import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from palpate.core.contact.tool.convex_tool import convex
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, plate, rod, sphere
from palpate.core.errors import PalpateError

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.01
WEDGE = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 1.5], [1, 1, 0.7]]) * 0.01
TOOLS = {
    "sphere": sphere(0.008),
    "rod": rod(0.004, 0.03),
    "plate": plate(0.03, 0.02),
    "cube": convex(CUBE),
    "wedge": convex(WEDGE, 0.0005),
    "polygon": Tool("polygon", WEDGE[:3], 0.002),
    "inner point": Tool("inner", np.vstack([CUBE, [[0.001, 0, 0]]]), 0.001),
}


@pytest.fixture(params=list(TOOLS))
def tool(request):
    return TOOLS[request.param]


def nearest_of_the_hull(tool, point):
    """Distance to the core's hull by quadratic programming over the weights of its points."""
    weights = minimize(
        lambda w: 1e6 * ((w @ tool.core - point) ** 2).sum(),
        np.full(len(tool.core), 1 / len(tool.core)),
        jac=lambda w: 2e6 * tool.core @ (w @ tool.core - point),
        bounds=[(0, 1)] * len(tool.core),
        constraints={"type": "eq", "fun": lambda w: w.sum() - 1, "jac": np.ones_like},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 500},
    ).x
    return np.linalg.norm(weights @ tool.core - point)


def test_outside_the_core_the_distance_is_that_of_a_quadratic_program(tool, rng):
    points = rng.normal(size=(30, 3)) * 0.02
    distance, _ = tool.distance(points)
    for point, found in zip(points, distance, strict=True):
        if found > -tool.radius:
            expected = nearest_of_the_hull(tool, point) - tool.radius
            assert found == pytest.approx(expected, abs=2e-7)


def test_inside_the_core_the_distance_is_the_least_that_leads_out(rng):
    tool = TOOLS["wedge"]
    points = rng.dirichlet(np.ones(len(tool.core)), 40) @ tool.core
    distance, normals = tool.distance(points)
    directions = rng.normal(size=(20000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    # The way out along a direction is at least the support there, and least at a face's normal.
    support = (directions @ tool.core.T).max(axis=1) + tool.radius
    for point, found, normal in zip(points, distance, normals, strict=True):
        least = (support - directions @ point).min()
        assert -found <= least + 1e-12
        assert -found == pytest.approx(least, abs=3e-4)
        assert (normal @ tool.core.T).max() + tool.radius - normal @ point == pytest.approx(-found)


def test_the_normal_is_the_gradient_of_the_distance(tool, rng):
    points = rng.normal(size=(200, 3)) * 0.015
    step = 1e-7
    distance, normals = tool.distance(points)
    gradient = np.column_stack(
        [
            (tool.distance(points + step * axis)[0] - tool.distance(points - step * axis)[0])
            for axis in np.eye(3)
        ]
    ) / (2 * step)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=1e-12)
    # Inside, where two places are equally near, there is no gradient.
    smooth = np.linalg.norm(gradient, axis=1) > 0.999
    assert smooth.mean() > 0.95
    np.testing.assert_allclose(normals[smooth], gradient[smooth], atol=1e-4)
    on_surface = points - distance[:, None] * normals
    outside = distance > -0.9 * tool.radius
    assert np.abs(tool.distance(on_surface[outside])[0]).max() < 1e-15


@given(st.integers(0, 2**32 - 1))
def test_the_distance_is_convex_and_changes_no_faster_than_the_place(seed):
    rng = np.random.default_rng(seed)
    tool = TOOLS[rng.choice(list(TOOLS))]
    a, b = rng.normal(size=(2, 20, 3)) * 0.02
    share = rng.random(20)
    between = tool.distance(a + share[:, None] * (b - a))[0]
    at_a, at_b = tool.distance(a)[0], tool.distance(b)[0]
    assert (between <= (1 - share) * at_a + share * at_b + 1e-15).all()
    assert (np.abs(at_a - at_b) <= np.linalg.norm(a - b, axis=1) + 1e-15).all()


def test_on_a_face_edge_and_corner_the_distance_is_zero_and_the_normal_a_unit():
    tool = Tool("box", CUBE, 1e-9)
    places = np.vstack([CUBE, CUBE[:1] * [0, 1, 1], CUBE[:1] * [0, 0, 1]])
    distance, normals = tool.distance(places)
    assert np.abs(distance).max() < 2e-9
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(normals[-1], [0, 0, -1])


def test_a_plate_works_with_its_lower_face():
    tool = plate(0.03, 0.02)
    places = np.array([[0, 0, -0.001], [0.012, -0.008, 0.001], [0.016, 0, 0.004], [0, 0, 0.01]])
    distance, normals = tool.distance(places)
    np.testing.assert_allclose(distance, [0.001, -0.001, 0.001, 0.0], atol=1e-15)
    np.testing.assert_allclose(normals, [[0, 0, -1], [0, 0, -1], [1, 0, 0], [0, 0, 1]], atol=1e-12)


def test_a_rounded_hull_lies_within_the_sharp_one_and_shares_its_faces(rng):
    tool = convex(CUBE, 0.002)
    assert tool.radius == 0.002
    np.testing.assert_allclose(tool.extents, 0.02)
    np.testing.assert_allclose(np.abs(tool.core), 0.008)
    assert tool.inner_radius == pytest.approx(0.01)


def test_a_fine_mesh_becomes_a_tool_of_few_corners_near_it(rng):
    vertices = rng.normal(size=(3000, 3))
    vertices *= 0.01 / np.linalg.norm(vertices, axis=1)[:, None]
    tool = convex(vertices)
    assert len(tool.core) <= 64
    distance, _ = tool.distance(vertices)
    assert distance.min() > -1e-12
    assert distance.max() < 0.0015


def test_widths_follow_the_tools_shape():
    assert sphere(0.01).size == pytest.approx(0.02)
    assert sphere(0.01).spacing == pytest.approx(0.002)
    assert rod(0.004, 0.05).size == pytest.approx(0.008)
    assert rod(0.004, 0.05).reach == pytest.approx(0.029)
    assert plate(0.04, 0.016).size == pytest.approx(0.016)
    assert plate(0.04, 0.016).spacing == pytest.approx(0.002)


def test_a_pose_takes_points_to_the_tool_and_refuses_what_is_no_rotation(rng):
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    pose = Pose.at([1, 2, 3], turn)
    own = rng.normal(size=(5, 3))
    np.testing.assert_allclose(pose.to_tool(own @ turn.T + [1, 2, 3]), own)
    for wrong in (2 * np.eye(3), np.diag([1, 1, -1]), np.full((3, 3), np.nan), np.eye(2)):
        with pytest.raises(PalpateError, match="rotation"):
            Pose.at([0, 0, 0], wrong)
    with pytest.raises(PalpateError, match="position"):
        Pose.at([0, 0])
    with pytest.raises(PalpateError, match="not finite"):
        Pose.at([0, 0, np.inf])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: sphere(0.0), "radius is 0.0; give a positive"),
        (lambda: sphere(float("nan")), "radius is nan"),
        (lambda: rod(0.01, -1.0), "length is -1.0"),
        (lambda: plate(0.01, 0.0), "depth is 0.0"),
        (lambda: plate(0.01, 0.01, 0.006), "leaves nothing of a plate"),
        (lambda: convex(CUBE[:4]), "lie in one plane"),
        (lambda: convex(CUBE[:2]), "choose a mesh with volume"),
        (lambda: convex(CUBE * np.nan), "not finite"),
        (lambda: convex(CUBE, -0.1), "rounding is -0.1"),
        (lambda: convex(CUBE, 0.0099), "leaves nothing of a hull"),
        (lambda: Tool("t", np.zeros((65, 3)), 0.1), "65 core points are more than the 64"),
        (lambda: Tool("t", np.zeros((0, 3)), 0.1), r"expected (k, 3) with k > 0"),
        (lambda: Tool("t", np.array([[0, np.inf, 0]]), 0.1), "not finite"),
    ],
)
def test_what_is_no_tool_is_refused_with_its_reason(make, message):
    with pytest.raises(PalpateError, match=re.escape(message)):
        make()
