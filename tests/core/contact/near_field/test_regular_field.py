"""Elements are believed where a body goes along with a force far more than that presses in."""

import numpy as np
import pytest
from bodies.soft_block import soft_block

from palpate.core.contact.near_field.compliance_beneath import near_correction
from palpate.core.contact.near_field.contact_points import contact_points
from palpate.core.contact.near_field.half_space import least_own_displacement
from palpate.core.contact.near_field.point_compliance import point_compliance
from palpate.core.contact.near_field.regular_field import RegularField
from palpate.core.rest.definite import as_matrix

SIDE, LENGTH = 0.006, 0.12


@pytest.fixture(scope="module")
def tail():
    """A rod of 6 mm, 120 mm long, that stands on its pinned end."""
    return soft_block((SIDE, SIDE, LENGTH), (2, 2, 40), 0.3, 0.2)


def test_a_tail_is_told_by_its_elements_and_its_root_by_the_ring(tail):
    heights = tail.mesh.nodes[tail.mesh.surface_nodes, 2]
    trusted = RegularField.of(tail).trusted
    assert not trusted[heights > 0.5 * LENGTH].any()
    assert (trusted[(heights > 0.0) & (heights < SIDE)] > 0.9).any()


def test_a_stout_block_is_told_by_its_rings():
    block = soft_block((0.05, 0.05, 0.05), (6, 6, 6), 0.3, 0.2)
    free = block.free_index(block.mesh.surface_nodes) >= 0
    assert RegularField.of(block).trusted[free].min() > 0.9


def test_no_forces_on_a_tail_give_energy(tail):
    points = contact_points(tail, SIDE / 2)
    upper = np.flatnonzero(points.positions[:, 2] > 0.5 * LENGTH)
    compliance = as_matrix(
        point_compliance(tail, points, upper, upper, near_correction(tail, points))
    )
    own = least_own_displacement(points.areas, points.normals, tail.poisson_ratio)[upper]
    assert np.linalg.eigvalsh(compliance)[0] > -1e-6 * own.min()
