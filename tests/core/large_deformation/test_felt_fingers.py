"""Several fingers that soften their own places."""

import numpy as np
import pytest

from palpate.core.large_deformation.felt_fingers import corrected_touches, solve_softened
from palpate.core.large_deformation.felt_force import Relation, corrected_touch
from palpate.core.large_deformation.softening_table import SofteningTable
from palpate.core.paper_cube import paper_cube
from palpate.core.soft_body import SoftBody
from palpate.core.stiffness import assemble
from palpate.core.surface_compliance import surface_compliance

AT = np.array([[0.015, 0.02, 0.05], [0.032, 0.027, 0.05]])


@pytest.fixture(scope="module")
def body():
    mesh, fixed = paper_cube()
    compliance = surface_compliance(mesh, assemble(mesh, 0.3), fixed, dtype=np.float64)
    return SoftBody(mesh, fixed, 0.3, compliance, 1e4)


@pytest.fixture(scope="module")
def softenings(body):
    table = SofteningTable(body)
    table.fill()
    return table.values


def relations_at(body, softenings, depths):
    touches = body.touch_several(AT, -np.asarray(depths)[:, None] * [0, 0, 1.0])
    return touches, corrected_touches(body, softenings, touches)


def test_a_finger_alone_has_its_own_relation(body, softenings):
    by = np.array([0.001, 0.0, -0.007])
    (touch,) = body.touch_several(AT[:1], by[None])
    place = body.closest_points.query(AT[:1])
    expected = corrected_touch(body, softenings, int(place.triangle[0]), place.alpha[0], by).force
    assert np.allclose(corrected_touches(body, softenings, [touch])[0].force, expected)
    compliance = body.contact_compliance(place.triangle, place.alpha)
    relation = Relation(np.linalg.inv(compliance[0, 0]), softenings[60, :3], softenings[60, 3])
    found = solve_softened(compliance, [relation], by[None], by[None])
    assert np.allclose(found[0], relation.force(by), rtol=1e-10)


def test_shallow_fingers_feel_the_linear_forces(body, softenings):
    linear, felt = relations_at(body, softenings, [1e-7, 2e-7])
    for one, other in zip(linear, felt, strict=True):
        assert np.allclose(one.force, other.force, rtol=1e-4)
        assert not np.array_equal(one.force, other.force)


def test_forces_are_the_gradient_of_an_energy(body, softenings):
    depths, step = np.array([0.007, 0.005]), 1e-5
    slopes = np.empty((2, 2))
    for q in range(2):
        ends = []
        for sign in (1, -1):
            moved = depths.copy()
            moved[q] += sign * step
            ends.append([touch.force[2] for touch in relations_at(body, softenings, moved)[1]])
        slopes[:, q] = (np.array(ends[0]) - ends[1]) / (2 * step)
    assert slopes[0, 1] == pytest.approx(slopes[1, 0], rel=1e-5)
    assert abs(slopes[0, 1]) > 1.0
    assert (np.linalg.eigvalsh(slopes) > 0).all()


def test_a_finger_that_others_draw_away_from_has_no_force(body, softenings):
    deep, shallow = relations_at(body, softenings, [0.01, 1e-5])[1]
    alone = body.touch_several(AT[:1], np.array([[0, 0, -0.01]]))
    assert shallow.force == pytest.approx([0, 0, 0], abs=1e-9)
    assert np.allclose(deep.force, corrected_touches(body, softenings, alone)[0].force, rtol=1e-9)
