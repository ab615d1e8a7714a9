"""Pressure between contact points, against what it was spread from."""

from __future__ import annotations

import numpy as np
import pytest

from palpate.core.contact.press import ContactSettings, Press
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.contact.traction import PressedPatch, tractions

SPACING, PRESSURE = 1e-3, 2000.0


def lattice(half, spacing, shift=0.0):
    """Places (p, 3) of a square lattice in the plane z = 0."""
    along = np.arange(-half, half + 1e-12, spacing) + shift
    x, y = np.meshgrid(along, along)
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])


def patch_under(pressure, half=0.01):
    """Points of a lattice that a pressure field (p,) of places presses."""
    places = lattice(half, SPACING)
    area = np.full(len(places), SPACING**2)
    up = np.tile([0.0, 0.0, 1.0], (len(places), 1))
    return PressedPatch(places, up, pressure(places) * area, area)


def bump(places):
    """A smooth pressure, of 2 kPa at most, on a disc of 6 mm."""
    share = np.linalg.norm(places[:, :2], axis=1) / 6e-3
    return PRESSURE * np.maximum(1.0 - share**2, 0.0) ** 2


def test_the_sum_of_pressure_and_area_is_the_force():
    patch = patch_under(bump)
    # A fine mesh over it: the integral is as good as its sum, and the kernel's is one.
    fine = lattice(0.02, 1e-4)
    found = tractions([patch], fine)
    force = found.sum(axis=0) * 1e-8
    np.testing.assert_allclose(force, [0.0, 0.0, patch.pushes.sum()], rtol=1e-6, atol=1e-12)


def test_an_even_pressure_is_even_between_its_points_and_nothing_beyond():
    patch = patch_under(lambda places: np.full(len(places), PRESSURE))
    inside = np.array([[0.0, 0.0, 0.0], [5e-4, 0.0, 0.0], [5e-4, 5e-4, 0.0], [2e-3, 1.3e-3, 0.0]])
    np.testing.assert_allclose(tractions([patch], inside)[:, 2], PRESSURE, rtol=0.04)
    outside = np.array([[0.0121, 0.0, 0.0], [0.0, 0.0, 2.1e-3]])
    assert not tractions([patch], outside).any()


def test_a_smooth_pressure_is_seen_where_it_is():
    places = lattice(4e-3, 3.7e-4)
    found = tractions([patch_under(bump)], places)[:, 2]
    np.testing.assert_allclose(found, bump(places), rtol=0, atol=0.08 * PRESSURE)


def test_patches_add_up_and_no_patch_is_nothing():
    places, patch = lattice(4e-3, 1e-3), patch_under(bump)
    once = tractions([patch], places)
    np.testing.assert_allclose(tractions([patch, patch], places), 2.0 * once, rtol=1e-12)
    assert not tractions([], places).any()
    empty = PressedPatch(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0))
    assert not tractions([empty], places).any()


@pytest.fixture(scope="module")
def touched(cube):
    """A fingertip 3 mm in the cube's top, without friction."""
    tool, (top, middle) = sphere(0.02), (cube.mesh.nodes[:, 2].max(), cube.mesh.nodes.mean(axis=0))
    press = Press(cube, [tool], ContactSettings())
    press.to([Pose(np.array([middle[0], middle[1], top + 0.021]), np.eye(3))])
    return press.to([Pose(np.array([middle[0], middle[1], top + 0.017]), np.eye(3))])[0]


def test_a_touch_s_force_is_that_of_its_pressure(touched):
    # By its own points it is exact: the force is the sum of pressure, area and normal.
    by_pressure = ((touched.pressures * touched.areas)[:, None] * -touched.normals).sum(axis=0)
    np.testing.assert_allclose(by_pressure, touched.force, rtol=1e-6, atol=1e-9)
    patch = PressedPatch.of_touch(touched)
    np.testing.assert_array_equal(patch.pushes, touched.pushes)
    # On the mesh of the tool's points themselves it is as coarse as they are.
    fine = np.column_stack([lattice(0.02, 1e-4)[:, :2], np.zeros(401**2)])
    fine[:, :2] += touched.pose.position[:2]
    depth = touched.pose.position[2] - np.sqrt(
        np.maximum(0.02**2 - ((fine[:, :2] - touched.pose.position[:2]) ** 2).sum(axis=1), 0.0)
    )
    fine[:, 2] = np.minimum(depth, touched.places[:, 2].max())
    slope = 1.0 / np.maximum(np.abs(touched.pose.position[2] - fine[:, 2]) / 0.02, 0.1)
    area = 1e-8 * np.where(depth < touched.places[:, 2].max(), slope, 1.0)
    force = (tractions([patch], fine) * area[:, None]).sum(axis=0)
    np.testing.assert_allclose(force[2], touched.force[2], rtol=0.05)


def test_a_finger_of_the_servo_tells_the_same(touched):
    patch = PressedPatch.of_touch(touched)
    other = PressedPatch.of_finger(
        touched.tool,
        touched.pose,
        touched.places + touched.displacements,
        touched.forces,
        touched.pressures,
    )
    np.testing.assert_allclose(other.pushes, patch.pushes, rtol=1e-6)
    np.testing.assert_allclose(other.areas, patch.areas, rtol=1e-6)
    np.testing.assert_allclose(other.normals, patch.normals, atol=1e-6)
