"""Several fingers that soften their own places."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.soft_block import soft_block
from referees.softened_points import STRONG, WEAK, coupled, couplings, relation_at

from palpate.core.contact.place import compliance_between
from palpate.core.contact.single_press import press_points, touch_nearest
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.force_at_depth.softening_table import SofteningTable

AT = np.array([[0.015, 0.02, 0.05], [0.032, 0.027, 0.05]])


@pytest.fixture(scope="module")
def body():
    return baked_body(*paper_cube(), dtype=np.float64)


@pytest.fixture(scope="module")
def softenings(body):
    table = SofteningTable(body)
    table.fill()
    return table.values


def touches_at(body, softenings, depths):
    """Linear and corrected touches, so deep."""
    by = -np.asarray(depths)[:, None] * [0, 0, 1.0]
    return press_points(body, AT, by), press_points(body, AT, by, softenings=softenings)


def alone_at(body, softenings, at=AT):
    """Compliance and relations of places alone."""
    places = body.closest_points.query(at)
    relations = [
        relation_at(body, softenings, int(triangle), alpha)
        for triangle, alpha in zip(places.triangle, places.alpha, strict=True)
    ]
    return compliance_between(body, places.triangle, places.alpha), relations


def test_shallow_fingers_feel_the_linear_forces(body, softenings):
    linear, felt = touches_at(body, softenings, [1e-7, 2e-7])
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
            ends.append([touch.force[2] for touch in touches_at(body, softenings, moved)[1]])
        slopes[:, q] = (np.array(ends[0]) - ends[1]) / (2 * step)
    assert slopes[0, 1] == pytest.approx(slopes[1, 0], rel=1e-5)
    assert abs(slopes[0, 1]) > 1.0
    assert (np.linalg.eigvalsh(slopes) > 0).all()


def test_a_finger_that_others_draw_away_from_has_no_force(body, softenings):
    deep, shallow = touches_at(body, softenings, [0.01, 1e-5])[1]
    relations = alone_at(body, softenings)[1]
    couplings_there = couplings(*alone_at(body, softenings))
    held = coupled(relations[0], couplings_there[0])
    assert shallow.force == pytest.approx([0, 0, 0], abs=1e-9)
    assert np.allclose(deep.force, -1e4 * held.force([0, 0, -0.01]), rtol=1e-9)


@pytest.fixture(scope="module")
def arm():
    """A bar 80 mm long and 20 mm thick, held at one end."""
    cube, _ = paper_cube(1.0)
    mesh = TetMesh.checked(cube.nodes * [0.08, 0.02, 0.02], cube.tets)
    fixed = np.flatnonzero(mesh.nodes[:, 0] < 1e-6)
    body = baked_body(mesh, fixed, dtype=np.float64)
    table = SofteningTable(body)
    table.fill()
    return body, table.values


PINCH = np.array([[0.065, 0.01, 0.0], [0.065, 0.01, 0.02]])


def test_a_pinch_of_a_slender_part_is_felt_as_the_linear_one(arm):
    body, values = arm
    for depth in (0.0003, 0.001, 0.002):
        by = depth * np.array([[0, 0, 1.0], [0, 0, -1.0]])
        touches = press_points(body, PINCH, by)
        felt = press_points(body, PINCH, by, softenings=values)
        for one, other in zip(touches, felt, strict=True):
            assert np.allclose(one.force, other.force, rtol=1e-9)
    compliance, relations = alone_at(body, values, PINCH)
    assert (couplings(compliance, relations) > STRONG).all()
    linear = touch_nearest(body, PINCH[0], [0, 0, 0.002])
    alone = touch_nearest(body, PINCH[0], [0, 0, 0.002], softenings=values)
    assert not np.allclose(alone.force, linear.force, rtol=0.01)


def test_what_is_felt_changes_continuously_with_the_places(arm):
    body, values = arm
    along = np.linspace(0.005, 0.075, 400)
    forces, strengths = [], []
    for x in along:
        at = np.array([[0.06, 0.011, 0.0], [x, 0.009, 0.02]])
        by = 0.002 * np.array([[0, 0, 1.0], [0, 0, -1.0]])
        felt = press_points(body, at, by, softenings=values)
        forces.append([touch.force for touch in felt])
        strengths.append(couplings(*alone_at(body, values, at)))
    strengths = np.array(strengths)
    assert strengths.min() < WEAK
    assert strengths.max() > STRONG
    steps = np.abs(np.diff(forces, axis=0)).max(axis=(1, 2))
    assert steps.max() < 0.03 * np.abs(forces).max()


@pytest.fixture(scope="module")
def ell():
    """Two bars 20 mm thick that meet in a corner; the shorter one is held by its upper end."""
    block = soft_block((0.1, 0.02, 0.08), (10, 2, 8)).mesh
    middles = block.nodes[block.tets].mean(axis=1)
    kept = block.tets[(middles[:, [0, 2]] < 0.02).any(axis=1)]
    used, numbered = np.unique(kept, return_inverse=True)
    mesh = TetMesh.checked(block.nodes[used], numbered.reshape(-1, 4))
    fixed = np.flatnonzero(mesh.nodes[:, 2] > 0.079)
    body = baked_body(mesh, fixed, 0.45, 5e3, "smoothed")
    table = SofteningTable(body)
    table.fill()
    return body, table.values


@pytest.mark.parametrize("count", [2, 3])
def test_fingers_at_random_places_of_slender_parts_have_an_answer(ell, count):
    body, values = ell
    rng = np.random.default_rng(12)
    for _ in range(40):
        places = rng.choice(len(body.mesh.surface_triangles), count, replace=False)
        corners = body.mesh.nodes[body.mesh.surface_triangles[places]]
        inward = -np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        inward /= np.linalg.norm(inward, axis=1)[:, None]
        for depth in (0.0004, 0.002, 0.006):
            felt = press_points(body, corners.mean(axis=1), depth * inward, softenings=values)
            assert np.isfinite([touch.force for touch in felt]).all()


def test_a_held_place_is_convex_and_alone_it_is_unchanged(body, softenings):
    rng = np.random.default_rng(3)
    compliance, relations = alone_at(body, softenings)
    assert couplings(compliance[:1, :1], relations[:1]).tolist() == [0.0]
    for relation in relations:
        same = coupled(relation, 0.0)
        assert np.array_equal(same.softening, relation.softening)
        assert same.saturation == relation.saturation
        linear = coupled(relation, STRONG)
        assert linear.force([0, 0, -0.01]) == pytest.approx(relation.stiffness @ [0, 0, -0.01])
        root = np.linalg.cholesky(np.linalg.inv(relation.stiffness))
        for coupling in np.linspace(0.0, 0.8, 17):
            held = coupled(relation, coupling)
            for _ in range(50):
                u = rng.normal(size=3) * 10 ** rng.uniform(-4, -1)
                seen = np.linalg.eigvalsh(root.T @ held.tangent(u) @ root)
                assert seen[0] > 0.049
                if coupling > 0.0:
                    assert seen[-1] <= coupling**-0.5 * (1 + 1e-9)
