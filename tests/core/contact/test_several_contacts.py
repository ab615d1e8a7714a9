"""Several fingers on one body: coupled, only pushing, on one place, coming and going."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.shared import free_triangles
from referees.jumps import largest_change
from referees.push_cones import assert_least, yielded

from palpate.core.contact.equations import two_node_forces
from palpate.core.contact.place import compliance_between
from palpate.core.contact.press import ContactSettings, PointGoal, Press
from palpate.core.contact.single_press import press_points, touch_at, touch_nearest
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh

TOP = 0.05
DOWN = np.array([0, 0, -0.004])
# On one place fingers find at least this share of what each yields alone.
DISTINCT = 0.02


@pytest.fixture(scope="module")
def slivers():
    """The paper's cube flattened to a sheet: every tetrahedron is a sliver."""
    mesh, fixed = paper_cube()
    flat = TetMesh.checked(mesh.nodes * [1, 1, 0.01], mesh.tets)
    return baked_body(flat, fixed)


@pytest.fixture(params=["cube", "mouse", "slivers"])
def any_body(request):
    return request.getfixturevalue(request.param)


def forces_of(body, at, by):
    return np.array([-touch.force for touch in press_points(body, at, by)])


def pressed(press, triangles, alphas, by):
    """Forces (m, 3) on the body of fingers that go on to places on triangles."""
    goals = [
        PointGoal(int(triangle), alpha, u)
        for triangle, alpha, u in zip(triangles, np.asarray(alphas, float), by, strict=True)
    ]
    return np.array([-touch.force for touch in press.to(goals)])


def as_matrix(compliance):
    size = 3 * len(compliance)
    return compliance.transpose(0, 2, 1, 3).reshape(size, size)


def integral(function, low, high, tolerance):
    """Trapezia, halved where the function is not straight: exact but for kinks, which get small."""

    def part(a, at_a, b, at_b):
        middle = 0.5 * (a + b)
        at_middle = function(middle)
        if abs(at_middle - 0.5 * (at_a + at_b)) * (b - a) <= tolerance:
            return (b - a) * (at_a + 4 * at_middle + at_b) / 6
        return part(a, at_a, middle, at_middle) + part(middle, at_middle, b, at_b)

    points = np.linspace(low, high, 9)
    values = [function(point) for point in points]
    return sum(
        part(*one) for one in zip(points[:-1], values[:-1], points[1:], values[1:], strict=True)
    )


def random_places(body, rng, count, *, together):
    """Triangles (m,) and alphas (m, 3), on one triangle or all over the body."""
    triangles = rng.choice(free_triangles(body), count, replace=True)
    if together:
        triangles[:] = triangles[0]
    return triangles, rng.dirichlet([1, 1, 1], count)


@pytest.mark.parametrize("together", [False, True])
def test_the_coupling_is_symmetric_and_never_negative(any_body, rng, together):
    for count in (2, 3, 5):
        for _ in range(5):
            places = random_places(any_body, rng, count, together=together)
            C = compliance_between(any_body, *places)
            size = np.abs(C).max()
            np.testing.assert_allclose(C, C.transpose(1, 0, 3, 2), rtol=0, atol=1e-12 * size)
            assert np.linalg.eigvalsh(as_matrix(C))[0] > -1e-6 * size


def test_two_fingers_on_nodes_give_equation_10(body):
    nodes = body.mesh.nodes[body.compliance.free_surface]
    i, j = int(np.argmin(nodes[:, 0])), int(np.argmax(nodes[:, 0]))
    blocks = body.compliance.blocks(np.array([i, j]), np.array([i, j])) / body.young_modulus
    by = 0.1 * np.ptp(nodes[:, 0]) * np.array([[0.3, 0.0, 0.02], [-0.2, 0.01, 0.0]])
    expected = two_node_forces(blocks, *by)
    np.testing.assert_allclose(forces_of(body, nodes[[i, j]], by), expected, rtol=1e-6)


def test_the_answer_meets_the_conditions_of_the_convex_problem(any_body, rng):
    """In the cones; what is left over in the dual cones; one across the other."""
    kinds = []
    for count in (1, 2, 3, 5):
        for _ in range(25):
            triangles, alphas = random_places(any_body, rng, count, together=False)
            if len(set(triangles)) < count:
                continue
            u = 1e-3 * (rng.normal(size=3) + rng.normal(size=(count, 3)))
            forces = pressed(Press(any_body, [None] * count), triangles, alphas, u)
            C = compliance_between(any_body, triangles, alphas) / any_body.young_modulus
            if min(yielded(C)) > 2.0 * DISTINCT:
                kinds += assert_least(C, u, u, forces, 1e-7)
    assert {"held", "slides"} <= set(kinds)


def test_what_was_before_does_not_change_the_answer(cube, rng):
    triangles, alphas = random_places(cube, rng, 4, together=True)
    u = DOWN + 1e-3 * rng.normal(size=(4, 3))
    expected = pressed(Press(cube, [None] * 4), triangles, alphas, u)
    press = Press(cube, [None] * 4)
    for _ in range(5):
        pressed(press, triangles, alphas, DOWN + 4e-3 * rng.normal(size=(4, 3)))
        again = pressed(press, triangles, alphas, u)
        np.testing.assert_allclose(again, expected, atol=1e-8 * np.abs(expected).max())


def test_a_finger_is_never_limited_while_it_is_alone(any_body, rng):
    for triangle in rng.choice(free_triangles(any_body), 20):
        alpha, by = rng.dirichlet([1, 1, 1]), 1e-3 * rng.normal(size=3)
        C = compliance_between(any_body, [triangle], alpha[None])[0, 0] / any_body.young_modulus
        force = -touch_at(any_body, triangle, alpha, by).force
        np.testing.assert_allclose(C @ force, by, atol=1e-6 * np.abs(by).max())


def test_a_finger_drawn_away_from_does_not_hold_the_surface(cube):
    deep, beside = [0.021, 0.024, TOP], [0.026, 0.024, TOP]
    forces = forces_of(cube, [deep, beside], [2 * DOWN, 0.2 * DOWN])
    np.testing.assert_array_equal(forces[1], 0)
    np.testing.assert_allclose(forces[0], -touch_nearest(cube, deep, 2 * DOWN).force, rtol=1e-9)


def test_a_finger_at_rest_is_pushed_by_what_another_bulges(cube):
    at = [[0, 0.025, 0.03], [0.05, 0.025, 0.03]]
    pushed, holding = forces_of(cube, at, [[0.004, 0, 0], [0, 0, 0]])
    assert pushed[0] > 0
    assert holding[0] < -0.05 * pushed[0]


def test_on_one_place_the_deepest_finger_carries_all(cube):
    at = [[0.021, 0.024, TOP]] * 3
    forces = forces_of(cube, at, [DOWN, 0.7 * DOWN, 0.9 * DOWN])
    np.testing.assert_allclose(forces[0], -touch_nearest(cube, at[0], DOWN).force, rtol=1e-9)
    np.testing.assert_allclose(forces[1:], 0, atol=1e-9 * np.abs(forces).max())


@pytest.mark.parametrize("at", [[0.021, 0.024, TOP], [0.02, 0.02, TOP]], ids=["inside", "node"])
def test_on_one_place_equal_fingers_share_alike(cube, at):
    alone = -touch_nearest(cube, at, DOWN).force
    for count in (2, 3, 5):
        forces = forces_of(cube, [at] * count, [DOWN] * count)
        np.testing.assert_allclose(forces, np.tile(forces[0], (count, 1)), rtol=1e-9)
        np.testing.assert_allclose(forces.sum(axis=0), alone, rtol=DISTINCT)


@pytest.mark.parametrize(
    "alphas",
    [
        [[1, 0, 0], [0, 1, 0], [0.5, 0.5, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.4, 0.3, 0.3]],
        [[0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6], [1 / 3, 1 / 3, 1 / 3], [0.3, 0.3, 0.4]],
    ],
    ids=["edge", "four on a triangle", "five on a triangle"],
)
def test_places_the_surface_cannot_tell_apart_share_continuously(body, alphas):
    """No force exceeds what all of them need, and small changes of depth change them little."""
    triangle = free_triangles(body)[11]
    corners = body.mesh.nodes[body.mesh.surface_triangles[triangle]]
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    down = -1e-3 * normal / np.linalg.norm(normal)
    C = compliance_between(body, [triangle] * len(alphas), np.array(alphas))
    firmest = 1e-3 * body.young_modulus / np.linalg.eigvalsh(np.einsum("ppij->pij", C)).min()
    depths = np.linspace(0.9, 1.1, 81)
    forces = []
    for depth in depths:
        u = np.tile(down, (len(alphas), 1))
        u[-1] *= depth
        forces.append(pressed(Press(body, [None] * len(u)), [triangle] * len(u), alphas, u))
    forces = np.array(forces)
    assert np.linalg.norm(forces, axis=2).max() < 3 * firmest
    jumps = largest_change(np.array(forces))
    assert jumps < np.diff(depths)[0] / DISTINCT * firmest


def test_fingers_pass_through_each_other_without_a_jump(cube):
    """Jumps become smaller with the steps, however near the fingers are."""
    first = np.array([0.024, 0.024, TOP])
    largest = []
    for steps in (60, 120, 240):
        beside = np.linspace(-0.003, 0.003, steps)
        forces = [
            forces_of(cube, [first, first + np.array([x, 0.3 * x, 0])], [DOWN, 0.999 * DOWN])
            for x in beside
        ]
        largest.append(largest_change(np.array(forces)))
    assert largest[0] > 1.6 * largest[1] > 1.6**2 * largest[2]
    assert largest[2] < 0.05 * np.linalg.norm(touch_nearest(cube, first, DOWN).force)


def test_a_finger_comes_and_goes_without_a_jump_as_it_is_pressed_in(cube):
    """The other one presses: it is let go where the surface is away, held where it is met."""
    at = [[0.021, 0.024, TOP], [0.031, 0.027, TOP]]
    largest, kinds = [], set()
    for steps in (50, 100, 200):
        forces = []
        for share in np.linspace(1e-6, 1, steps):
            forces.append(forces_of(cube, at, [DOWN, share * DOWN]))
            kinds.add(bool(forces[-1][1].any()))
        largest.append(largest_change(np.array(forces)))
    assert kinds == {False, True}
    np.testing.assert_allclose(np.divide(largest[:-1], largest[1:]), 2, rtol=0.15)


def test_work_of_two_fingers_on_a_closed_path_is_zero(cube):
    """Also where one of them is let go and met again on the way."""
    at = np.array([[0.021, 0.024, TOP], [0.030, 0.026, TOP]])
    towards = np.array([[0.1, 0, -1], [0, 0.15, -1]])
    corners = 1e-3 * np.array([[0.5, 0.3], [4.5, 0.5], [4.0, 3.0], [1.0, 2.5]])
    let_go = set()

    def along(start, step):
        """Work per share of a straight part of the path."""

        def rate(share):
            forces = forces_of(cube, at, (start + share * step)[:, None] * towards)
            let_go.add(not forces[1].any())
            return float(np.sum(forces * step[:, None] * towards))

        return rate

    steps = np.roll(corners, -1, axis=0) - corners
    work = [
        integral(along(start, step), 0.0, 1.0, 1e-9)
        for start, step in zip(corners, steps, strict=True)
    ]
    assert let_go == {False, True}
    assert abs(sum(work)) < 1e-6 * np.abs(work).sum()


def test_in_paper_mode_every_finger_is_answered_as_if_alone(cube):
    at, by = [[0, 0.025, 0.03], [0.05, 0.025, 0.03]], [[0.004, 0, 0], [-0.004, 0, 0]]
    for touch, a, b in zip(
        press_points(cube, at, by, ContactSettings(mode="paper")), at, by, strict=True
    ):
        np.testing.assert_array_equal(
            touch.force, touch_nearest(cube, a, b, ContactSettings(mode="paper")).force
        )


@pytest.mark.parametrize(
    ("at", "by", "said"),
    [
        ([[0, 0, 0]], [[0, 0, 1], [0, 0, 1]], "1 times and --by 2 times"),
        ([], [], "--at is given 0 times"),
        ([[0, 0, np.nan]], [[0, 0, 0]], "--at"),
    ],
)
def test_fingers_that_make_no_sense_are_refused(cube, at, by, said):
    with pytest.raises(PalpateError, match=said):
        press_points(cube, at, by)
