"""The half-space in closed form, against integrals and limits known otherwise."""

import numpy as np
import pytest

from palpate.core.contact.near_field.half_space import own_displacement, surface_displacement

UP = np.array([0.0, 0.0, 1.0])
NU = 0.3


def blocks_at(offsets, nu=NU):
    offsets = np.atleast_2d(offsets)
    return surface_displacement(offsets, np.tile(UP, (len(offsets), 1)), nu)


def disc(radius, rings):
    """Points and areas of a polar grid with cells of equal shares of the area, (m, 2), (m,)."""
    places, areas = [], []
    for ring in range(rings):
        inner, outer = radius * ring / rings, radius * (ring + 1) / rings
        count = 6 * (2 * ring + 1)
        angle = 2 * np.pi * (np.arange(count) + 0.5) / count
        # The middle of the two, for which a ring's 1/r at the centre is exact.
        middle = (inner + outer) / 2
        places.append(middle * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]))
        areas.append(np.full(count, np.pi * (outer**2 - inner**2) / count))
    return np.concatenate(places), np.concatenate(areas)


def test_a_disc_of_even_pressure_sinks_as_in_closed_form():
    """Johnson 3.29: 2 (1 - nu^2) p a / E in the middle, 2/pi of that at the rim."""
    radius, pressure = 0.01, 3.0
    places, areas = disc(radius, 60)
    middle = np.einsum("k,k->", pressure * areas, blocks_at(-places)[:, 2, 2])
    assert middle == pytest.approx(2 * (1 - NU**2) * pressure * radius, rel=2e-3)
    rim = np.array([radius * 1.0, 0, 0]) - places
    sunk = np.einsum("k,k->", pressure * areas, blocks_at(rim)[:, 2, 2])
    assert sunk == pytest.approx(4 / np.pi * (1 - NU**2) * pressure * radius, rel=1e-2)


def test_an_even_pressure_draws_the_surface_inwards():
    """Johnson 3.29b: inside a pressed disc, (1 - 2 nu) (1 + nu) p r / 2 E towards the middle."""
    radius, seen = 0.01, np.array([0.004, 0.0, 0.0])
    places, areas = disc(radius, 80)
    push = -UP
    moved = np.einsum("k,kxy,y->x", areas, blocks_at(seen - places), push)
    assert moved[0] == pytest.approx(-(1 - 2 * NU) * (1 + NU) * seen[0] / 2, rel=1e-2)


def test_an_even_traction_along_a_disc_moves_its_middle_as_in_closed_form():
    """The mean of e e^T is half the identity, so q a (1 + nu) (2 - nu) / E (Cerruti)."""
    places, areas = disc(0.01, 40)
    moved = np.einsum("k,kxy->xy", areas, blocks_at(-places))
    across = 0.01 * (1 + NU) * (2 - NU)
    np.testing.assert_allclose(moved[:2, :2], across * np.eye(2), atol=2e-3 * across)
    np.testing.assert_allclose(moved[:2, 2], 0, atol=1e-6 * across)


def test_forces_are_reciprocal(rng):
    offsets = rng.normal(size=(50, 3)) * [1, 1, 0]
    there, back = blocks_at(offsets), blocks_at(-offsets)
    np.testing.assert_allclose(there, back.transpose(0, 2, 1), rtol=1e-12)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
def test_a_square_lattice_of_points_acts_as_the_pressure_it_stands_for(nu):
    """A smooth hill of pressure, known by a lattice twice and four times as fine."""
    sunk = []
    for step in (0.5, 0.25, 0.125):
        line = np.arange(-6, 6 + step / 2, step)
        x, y = (axis.ravel() for axis in np.meshgrid(line, line))
        places = np.column_stack([x, y, 0 * x])
        forces = step**2 * np.exp(-(x**2 + y**2))
        others = np.linalg.norm(places, axis=1) > 1e-9
        own = own_displacement(np.array([step**2]), UP[None], nu)[0, 2, 2]
        sunk.append(own * step**2 + forces[others] @ blocks_at(places[others], nu)[:, 2, 2])
    exact = (1 - nu**2) / np.pi * np.pi**1.5
    assert sunk[0] == pytest.approx(exact, rel=1e-2)
    assert sunk[2] == pytest.approx(exact, rel=2e-4)


def test_a_lattice_is_positive_definite():
    line = np.arange(9.0)
    x, y = (axis.ravel() for axis in np.meshgrid(line, line))
    places = np.column_stack([x, y, 0 * x])
    for nu in (0.0, 0.3, 0.49):
        whole = np.empty((len(places), len(places), 3, 3))
        for i, place in enumerate(places):
            rest = np.arange(len(places)) != i
            whole[i, rest] = blocks_at(place - places[rest], nu)
            whole[i, i] = own_displacement(np.ones(1), UP[None], nu)[0]
        matrix = whole.transpose(0, 2, 1, 3).reshape(3 * len(places), -1)
        assert np.linalg.eigvalsh(matrix).min() > 0.2 * np.diag(matrix).min()
