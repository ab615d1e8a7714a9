"""Warping by rotations: what it must leave, turn and keep, and its transposed derivative."""

from dataclasses import replace

import numpy as np
import pytest

from palpate.core.compliance.elimination.cholesky import RepeatedElimination
from palpate.core.law.of_material import law_of
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.rotation_strain.relaxation import Relaxation
from palpate.core.shape.solid.solid import solid

EDGE = 0.05


def coordinates_of(mesh, free, young_scale=None):
    (term,) = solid(mesh, 0.3, law_of(0.3), young_scale=young_scale).terms
    each, positions = np.arange(len(free)), mesh.nodes[free]
    # The stiffness plays no part here, and a body held at one node has no factor of it.
    unit = RepeatedElimination.of(each, each, positions).factor(
        np.tile(np.eye(3), (len(free), 1, 1))
    )
    free_term = replace(term, gradients=term.gradients[:, free])
    return Relaxation.of([free_term], law_of(0.3), unit, positions).native


@pytest.fixture(scope="module")
def held_cube():
    """A cube held at one node only, which may turn about it."""
    mesh, _ = paper_cube(cells=3)
    return mesh.nodes[1:], coordinates_of(mesh, np.arange(1, len(mesh.nodes)))


@pytest.fixture(scope="module")
def pinned_cube():
    mesh, fixed = paper_cube(cells=3)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    return mesh.nodes[free], coordinates_of(mesh, free)


def wavy(positions, size):
    """A displacement that strains and turns every tetrahedron in another way, (f, 3)."""
    x, y, z = positions.T / EDGE
    return size * EDGE * np.stack([z * np.sin(3 * y), z * z * np.cos(2 * x), z * (x - y)], axis=1)


def test_a_linear_rotation_becomes_the_rotation(held_cube):
    positions, coordinates = held_cube
    vector = np.array([0.3, -1.1, 0.7])
    linear = np.cross(vector, positions)
    angle = np.linalg.norm(vector)
    axis = vector / angle
    along = np.outer(positions @ axis, axis)
    turned = along + (positions - along) * np.cos(angle) + np.cross(axis, positions) * np.sin(angle)
    found = coordinates.warped(linear)
    np.testing.assert_allclose(found, turned - positions, atol=1e-12 * EDGE)
    # The linear one has grown instead.
    assert np.linalg.norm(positions + linear, axis=1).max() > 1.5 * np.sqrt(3) * EDGE


def test_a_stretch_is_the_one_whose_rubber_stress_is_linear_in_the_force(held_cube):
    positions, coordinates = held_cube
    for strain in (-0.1, 0.05, 0.2):
        found = coordinates.warped(strain * positions * [1, 0, 0])
        stretch = 1.0 + found[:, 0][positions[:, 0] > 0] / positions[:, 0][positions[:, 0] > 0]
        # To fourth order, where l - 1/l has e^5.
        assert np.abs(stretch - 1 / stretch - 2 * strain).max() < abs(strain) ** 5
        np.testing.assert_allclose(found[:, 1:], 0, atol=1e-12 * EDGE)


def test_it_agrees_with_the_linear_displacement_to_second_order(pinned_cube):
    positions, coordinates = pinned_cube
    errors = []
    for size in (1e-3, 2e-3):
        linear = wavy(positions, size)
        errors.append(np.linalg.norm(coordinates.warped(linear) - linear))
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=0.02)


def test_a_mirrored_body_is_warped_into_the_mirror_image():
    mesh, fixed = paper_cube(cells=4)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    positions = mesh.nodes[free]
    coordinates = coordinates_of(mesh, free)
    mirror = np.array([-1.0, 1.0, 1.0])
    mirrored = positions * mirror + [EDGE, 0, 0]
    # With an even number of cells the mirrored mesh is the same one.
    partner = np.lexsort(np.round(positions / EDGE, 6).T)[
        np.argsort(np.lexsort(np.round(mirrored / EDGE, 6).T))
    ]
    np.testing.assert_allclose(positions[partner], mirrored, atol=1e-12)
    linear = wavy(positions, 0.5)
    found = coordinates.warped(linear)
    of_mirrored = coordinates.warped(mirror * linear[partner])
    np.testing.assert_allclose(of_mirrored, (mirror * found)[partner], atol=1e-12 * EDGE)


def test_the_pulled_back_force_does_the_same_work(pinned_cube, rng):
    positions, coordinates = pinned_cube
    forces, way = rng.normal(size=(2, *positions.shape))
    for size in (1e-3, 0.4, 1.5):
        linear = wavy(positions, size)
        step = 1e-6 * EDGE * way
        ends = [coordinates.warped(linear + sign * step) for sign in (1, -1)]
        work = (forces * (ends[0] - ends[1])).sum() / 2
        pulled_back = coordinates.pulled_back(linear, forces)
        assert (pulled_back * step).sum() == pytest.approx(work, rel=1e-6)


def test_what_is_stiff_keeps_its_size():
    mesh, fixed = paper_cube(cells=4)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), fixed)
    middle = mesh.nodes[mesh.tets].mean(axis=1)
    is_bone = middle[:, 2] > 0.5 * EDGE
    linear = wavy(mesh.nodes[free], 0.3)
    # Bone that is turned only: its gradients are made to fit by those around it.
    in_bone = np.isin(free, mesh.tets[is_bone])
    turn = np.cross([0.0, 0.9, 0.0], mesh.nodes[free] - [EDGE / 2, EDGE / 2, EDGE])
    linear[in_bone] = turn[in_bone]
    growth = []
    for scale in (None, np.where(is_bone, 1e4, 1.0)):
        moved = mesh.nodes.copy()
        moved[free] += coordinates_of(mesh, free, scale).warped(linear)
        a, b, c, d = moved[mesh.tets[is_bone]].transpose(1, 0, 2)
        volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        growth.append(np.abs(volumes / mesh.tet_volumes[is_bone] - 1).max())
    assert growth[0] > 0.03
    assert growth[1] < 1e-3
