"""Polygons on a line and near a point, against every triangle by itself."""

import numpy as np
import pytest
from palpate_servo import nearest_polygon, polygons_on_line

from palpate.core.body.drawn_polygons import Polygons
from palpate.core.mesh.closest_point import closest_area_coordinates


@pytest.fixture
def soup(rng):
    """Triangles anywhere."""
    places = rng.normal(size=(900, 3)).astype(np.float32)
    numbers = np.arange(900, dtype=np.int32)
    return Polygons(places, numbers, numbers[::3].copy())


def corners_of(soup):
    return soup.places.reshape(-1, 3, 3).astype(np.float64)


def test_a_line_goes_through_what_it_has_on_all_sides(soup, rng):
    for _ in range(20):
        origin, along = rng.normal(size=(2, 3))
        around = corners_of(soup) - origin
        # On one side of the line all three edges turn alike.
        turns = np.cross(around, np.roll(around, -1, axis=1)) @ along
        through = np.flatnonzero((turns > 0).all(axis=1) | (turns < 0).all(axis=1))
        np.testing.assert_array_equal(soup.on_line(origin, along), through)


def test_the_nearest_is_the_nearest_triangle(soup, rng):
    corners = corners_of(soup)
    for point in 2.0 * rng.normal(size=(50, 3)):
        alpha = closest_area_coordinates(np.repeat(point[None], 300, axis=0), corners)
        away = np.linalg.norm(np.einsum("tc,tcx->tx", alpha, corners) - point, axis=1)
        assert away[soup.nearest(point)] == pytest.approx(away.min(), rel=1e-6)


def test_what_does_not_fit_is_refused(soup):
    wrong = np.array([900], dtype=np.int32)
    arrays = (soup.places, wrong, np.zeros(1, dtype=np.int32))
    with pytest.raises(ValueError, match="corners name places"):
        polygons_on_line(*arrays, [0, 0, 0], [0, 0, 1])
    with pytest.raises(ValueError, match="corners name places"):
        nearest_polygon(*arrays, [0, 0, 0])
    with pytest.raises(ValueError, match="with a length"):
        soup.on_line(np.zeros(3), np.zeros(3))
    with pytest.raises(ValueError, match="must be finite"):
        soup.nearest(np.array([np.nan, 0, 0]))
