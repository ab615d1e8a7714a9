"""Tools on a graded block beside closed forms, as in benchmarks/contact/contact_closed_forms.py."""

import numpy as np
import pytest
from bodies.fingertip_on_cube import MOVED, pressed
from bodies.graded_block import YOUNG_MODULUS, graded_block, lift, nodes_as_points
from referees.closed_forms import hertz, punch, small_contacts

from palpate.core.contact.near_field.compliance_beneath import near_correction
from palpate.core.contact.near_field.regular_field import RegularField
from palpate.core.contact.press import ContactSettings, Press
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere

ELEMENT = 1e-3
CORE = 5

# Newton.
REFEREE = (0.0333, 0.0948, 0.1623)


@pytest.fixture(scope="module")
def block():
    return graded_block(ELEMENT, CORE, 0.45)


@pytest.fixture(scope="module")
def points(block):
    return nodes_as_points(block, CORE * ELEMENT)


@pytest.mark.parametrize("near", [pytest.param(False, marks=pytest.mark.at_length), True])
def test_a_sphere_is_resisted_as_hertz_says(block, points, near):
    correction = near_correction(block, points) if near else None
    rows = hertz(block, points, correction, lift(block, points, ELEMENT), CORE)
    radius, force, exponent = rows[-1]
    assert radius > 4
    assert force == pytest.approx(1.0, abs=0.05)
    assert exponent == pytest.approx(1.5, rel=0.03)


def test_a_flat_punch_is_resisted_as_the_closed_form_says(block, points):
    assert punch(block, points, None, lift(block, points, ELEMENT)) == pytest.approx(1, abs=0.05)


def test_a_sphere_that_is_pushed_aside_sticks_and_slips_as_cattaneo_and_mindlin_say(block, points):
    # Tangential force Q against displacement x: Q = mu P (1 - (1 - x / x_slip)^1.5), with
    # x_slip = 3 mu P (2 - nu) / (16 a G); K. L. Johnson, Contact Mechanics (1985), 7.2.
    tool, friction, radius = sphere(0.1), 0.5, 4 * ELEMENT
    depth = radius**2 / 0.1
    press = Press(block, [tool], ContactSettings(friction=friction), spread=(points, None))
    for share in (-0.1, 0.3, 0.6, 0.8, 1.0):
        (touch,) = press.to([Pose.at([0.0, 0.0, 0.1 - share * depth])])
    normal_lift, side_lift = (lift(block, points, ELEMENT, axis) for axis in (2, 0))
    push = touch.force[2]
    contact_radius = np.sqrt(0.1 * (depth - normal_lift * push))
    shear = YOUNG_MODULUS / (2 * 1.45)
    slips = 3 * friction * push * (2 - 0.45) / (16 * contact_radius * shear)
    for share in (0.15, 0.3, 0.45, 0.6, 0.75, 1.5):
        pose = Pose.at([share * slips, 0.0, 0.1 - depth])
        (touch,) = press.to([pose])
        drag = -touch.force[0]
        moved = share * slips - side_lift * drag
        expected = friction * push * (1 - max(0.0, 1 - moved / slips) ** 1.5)
        assert drag == pytest.approx(expected, abs=0.04 * friction * push)
        aside = touch.forces - touch.pushes[:, None] * touch.normals
        assert (np.linalg.norm(aside, axis=1) <= friction * touch.pushes * (1 + 1e-9)).all()


@pytest.mark.at_length
def test_small_contacts_are_resisted_as_hertz_says(block, points):
    """At a node, on an edge and in a triangle; the elements alone are 1.3 to 2.7 times too firm."""
    field, shift = RegularField.of(block), lift(block, points, ELEMENT)
    for elements in (0.5, 1.0):
        np.testing.assert_allclose(small_contacts(field, shift, elements), 1.0, atol=0.03)


def test_a_fingertip_on_a_cube_is_resisted_as_by_another_finite_element_method():
    """At 0.05, 0.1, 0.14 of the radius; benchmarks/contact/contact_referee.py has finer meshes.

    That is scikit-fem with quadratic elements and a contact of its own.
    """
    forces = pressed(8, fine=True) / np.array(REFEREE)
    np.testing.assert_allclose(forces, 1.0, atol=0.015)


def test_so_it_is_in_the_fingertips_own_points_wherever_they_lie():
    moved = [MOVED[place] for place in (0, 3, 4, 5)]
    forces = np.array([pressed(8, fine=False, moved=one) for one in moved])
    ratios = forces[:, 1:] / REFEREE[1:]
    np.testing.assert_allclose(ratios, 1.0, atol=0.03)
    np.testing.assert_allclose(ratios.mean(axis=0), 1.0, atol=0.015)
