"""What a table claims of its entries, against Newton's method."""

import numpy as np
import pytest

from palpate.core.shape.paper import series_entries as entries_module
from palpate.core.shape.paper.power_series import SeriesSolid
from palpate.core.shape.paper.series_entries import (
    POLISHED_ERROR,
    TOLERANCE,
    SeriesReach,
    series_entries,
)
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium


def chosen(solid, count):
    every = 3 * len(solid.body.surface)
    return np.random.default_rng(17).choice(every, count, replace=False)


def true_errors(solid, freedoms, found):
    """Of the entries at +F0 and -F0, relative, by Newton's method, (k, 2)."""
    errors = np.empty((len(freedoms), 2))
    loads = solid.unit_loads(freedoms)
    surface = solid.body.surface
    first = solid.solve(loads)[surface]
    for at, force in enumerate(found.largest_force):
        for side, sign in enumerate((1.0, -1.0)):
            true = equilibrium(solid.body, sign * force * loads[:, :, at]).displacements[surface]
            entry = first[:, :, at] * sign * force
            entry = entry + found.second[:, at].reshape(-1, 3) * force**2
            entry = entry + found.third[:, at].reshape(-1, 3) * sign * force**3
            errors[at, side] = np.linalg.norm(entry - true) / np.linalg.norm(true)
    return errors


@pytest.mark.parametrize("name", ["cube", "mouse"])
def test_the_claimed_error_holds(name, request):
    solid = SeriesSolid(FreeSolid.of(request.getfixturevalue(name)))
    freedoms = chosen(solid, 2)
    found = series_entries(solid, freedoms)
    assert (found.bound <= TOLERANCE).all()
    errors = true_errors(solid, freedoms, found)
    assert (errors <= found.bound[:, None]).all()
    # It is a claim, not a guess: no more than some ten times what is true.
    assert (errors.max(axis=1) > 0.05 * found.bound).all()


def test_an_entry_whose_claim_is_too_large_is_polished(cube, monkeypatch):
    solid = SeriesSolid(FreeSolid.of(cube))
    monkeypatch.setattr(entries_module, "TOLERANCE", 1e-4)
    freedoms = chosen(solid, 3)
    found = series_entries(solid, freedoms)
    assert found.is_polished.all()
    assert (found.bound == POLISHED_ERROR).all()
    assert (true_errors(solid, freedoms, found) <= POLISHED_ERROR).all()


def test_an_entry_that_may_not_be_polished_has_a_smaller_force(cube, monkeypatch):
    solid = SeriesSolid(FreeSolid.of(cube))
    wanted = series_entries(solid, chosen(solid, 3))
    monkeypatch.setattr(entries_module, "TOLERANCE", 1e-3)
    found = series_entries(solid, chosen(solid, 3), may_polish=False)
    assert found.is_short.all()
    assert (found.largest_force < wanted.largest_force).all()
    assert (found.bound <= 1e-3).all()
    assert (true_errors(solid, chosen(solid, 3), found) <= found.bound[:, None]).all()


def test_where_the_solid_gives_way_the_force_is_smaller(cube, monkeypatch):
    solid = SeriesSolid(FreeSolid.of(cube))
    wanted = series_entries(solid, chosen(solid, 4)).largest_force
    monkeypatch.setattr(entries_module, "WANTED_SHARE", 2.0)
    found = series_entries(solid, chosen(solid, 4))
    left = ~found.is_polished
    assert left.any()
    np.testing.assert_array_equal(left, found.is_short)
    assert (found.bound[left] <= TOLERANCE).all()
    assert (found.largest_force[left] < 3 * wanted[left]).all()


def test_the_reach_of_a_tolerance_is_where_the_claim_meets_it():
    reach = SeriesReach(np.array([1.0, 1e-6]), np.array([0.3, 1.0]))
    share = reach.within(0.01)
    assert (reach.bound(share) <= 0.01).all()
    assert reach.bound(1.2 * share)[0] > 0.01
    assert np.isinf(reach.bound(np.array([2.0, 0.6]))[1])


def test_a_place_that_is_about_to_give_way_counts_as_much_as_the_whole(rng):
    body = rng.standard_normal((50, 3, 1))
    terms = [0.1**order * body for order in range(4)]
    whole = SeriesReach.of(terms)
    for order, term in enumerate(terms):
        term[7] = 0.5**order * 5 * np.abs(body).max()
    assert whole.ratio[0] == pytest.approx(0.1)
    assert SeriesReach.of(terms).ratio[0] >= 0.5
