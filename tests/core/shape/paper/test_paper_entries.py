"""Entries of the paper's tables against equilibria found on other ways, and where F0 must give."""

import numpy as np
import pytest
from bodies.bare_body import bare_body
from referees.newton_entries import largest_carried, unit_load
from referees.nonlinear_reference import ST_VENANT_KIRCHHOFF, NonlinearReference

from palpate.core.errors import CancelledError
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper import paper_entries
from palpate.core.shape.paper.paper_entries import SETTLED, EntryFinder, usual_largest_force
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import NoEquilibrium, equilibrium


@pytest.fixture(scope="module")
def cube():
    mesh, fixed = paper_cube(cells=2)
    return FreeSolid.of(bare_body(mesh, fixed, 0.45), StVenantKirchhoff()), mesh


@pytest.fixture(scope="module")
def finder(cube):
    return EntryFinder(cube[0])


@pytest.mark.parametrize("freedom", [0, 13, 30])
def test_entries_are_what_another_program_finds(cube, finder, freedom):
    body, mesh = cube
    found = finder.entries(freedom, usual_largest_force(mesh))
    reference = NonlinearReference(mesh, body.free, 0.45, ST_VENANT_KIRCHHOFF)
    for entries, load in zip(found.per_force, found.largest * [1, -1], strict=True):
        expected = reference.displacements(load * unit_load(body, freedom), 2)[body.surface] / load
        error = np.linalg.norm(entries - expected.ravel())
        assert error < 2 * SETTLED * np.linalg.norm(expected)


def test_newtons_method_alone_finds_the_same_and_hardly_a_larger_force(cube, finder):
    body, mesh = cube
    wanted, smaller, by_series = usual_largest_force(mesh), 0, 0
    for freedom in range(1, 3 * len(body.surface), 5):
        found = finder.entries(freedom, wanted)
        by_series += int(found.by_series.sum())
        for at, sign in enumerate((1.0, -1.0)):
            load, truth = largest_carried(body, freedom, sign * wanted)
            smaller += found.largest[at] < abs(load)
            if found.largest[at] == abs(load):
                expected = truth.displacements[body.surface].ravel() / load
                error = np.linalg.norm(found.per_force[at] - expected)
                assert error < 2 * SETTLED * np.linalg.norm(expected)
    assert smaller <= 3
    assert by_series >= 5


def test_the_usual_force_is_the_papers_on_its_cube(cube):
    assert 10_000.0 * usual_largest_force(cube[1]) == pytest.approx(2.0)


def test_where_the_solid_gives_way_the_force_is_halved_until_it_holds(cube, finder):
    body, _ = cube
    freedom, wanted = 3 * int(np.argmax(body.positions[body.surface, 2])) + 2, 1e-3
    found = finder.entries(freedom, wanted)
    halvings = np.log2(wanted / found.largest[1])
    assert halvings == round(halvings) >= 1
    with pytest.raises(NoEquilibrium):
        equilibrium(body, -2.0 * found.largest[1] * unit_load(body, freedom))


def test_what_the_series_does_not_settle_newtons_method_does(cube, finder, monkeypatch):
    wanted = usual_largest_force(cube[1])
    by_series = finder.entries(30, wanted)
    monkeypatch.setattr(paper_entries, "SETTLED", 0.0)
    by_newton = finder.entries(30, wanted)
    assert not by_newton.by_series.any()
    np.testing.assert_array_equal(by_newton.largest, by_series.largest)
    np.testing.assert_allclose(by_newton.per_force, by_series.per_force, atol=1e-4 * 50)


def test_a_freedom_that_carries_nothing_stays_linear(cube, finder, monkeypatch):
    body, mesh = cube
    monkeypatch.setattr(paper_entries, "TRUSTED_CHANGE", 0.0)
    wanted = usual_largest_force(mesh)
    found = finder.entries(4, wanted)
    linear = body.linear(unit_load(body, 4))[body.surface].ravel()
    np.testing.assert_allclose(found.per_force, [linear, linear], rtol=1e-5)
    assert (found.largest == wanted).all()


def test_it_can_be_cancelled(finder):
    def cancelled():
        raise CancelledError("enough")

    with pytest.raises(CancelledError):
        finder.entries(0, 1e-4, cancelled)
