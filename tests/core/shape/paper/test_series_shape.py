"""The shape by power series: of the whole load, and from a table that is kept."""

from dataclasses import replace

import numpy as np
import pytest

from palpate.core.body.soft_body import SoftBody
from palpate.core.errors import PalpateError
from palpate.core.shape.paper.power_series import SeriesSolid
from palpate.core.shape.paper.series_entries import series_entries
from palpate.core.shape.paper.series_shape import SeriesShape
from palpate.core.shape.paper.series_table import SeriesTable
from palpate.core.shape.paper.table_file import TableFileError, table_path
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium
from palpate.core.stiffness.freedoms import freedoms

EDGE = 0.05


@pytest.fixture(params=[True, False], ids=["whole-load", "freedoms"])
def whole_load(request):
    return request.param


def touched(cube):
    """A triangle in the top, and a push of 0.1 N on each of its nodes, a little aslant."""
    corners = cube.mesh.surface_triangles
    middles = cube.mesh.nodes[corners].mean(axis=1)
    nearest = np.argmin(np.linalg.norm(middles - [EDGE / 2, EDGE / 3, EDGE], axis=1))
    return corners[nearest], np.tile([0.02, 0.0, -0.1], (3, 1))


def made(cube, whole_load, path=None):
    shape = SeriesShape(cube, path, whole_load)
    shape.wait_for(touched(cube)[0])
    return shape


def test_it_is_nearer_to_the_truth_than_the_linear_shape(cube, whole_load):
    nodes, forces = touched(cube)
    solid = FreeSolid.of(cube)
    load = solid.on_free_nodes(nodes, 2.5 * forces / cube.young_modulus)
    true = equilibrium(solid, load).displacements[solid.surface]
    linear = cube.deform(nodes, 2.5 * forces)
    shape = made(cube, whole_load)
    drawn = shape.displacements(nodes, 2.5 * forces)
    shape.close()
    error, before = np.linalg.norm(drawn - true), np.linalg.norm(linear - true)
    assert error < (0.2 if whole_load else 0.6) * before


def test_it_is_smooth_in_the_force_and_never_runs_away(cube, whole_load):
    nodes, forces = touched(cube)
    shape = made(cube, whole_load)
    steps = np.linspace(-40, 40, 321)
    drawn = np.array([shape.displacements(nodes, step * forces) for step in steps])
    shape.close()
    change = np.linalg.norm(np.diff(drawn, axis=0), axis=(1, 2))
    linear = np.linalg.norm(cube.deform(nodes, (steps[1] - steps[0]) * forces))
    assert change.max() < 4 * linear
    bend = np.linalg.norm(np.diff(drawn, n=2, axis=0), axis=(1, 2))
    assert bend.max() < 0.5 * linear
    # Straight in the end, on both sides.
    assert max(bend[0], bend[-1]) < 1e-3 * linear


def test_an_empty_table_is_linear_and_says_so(cube):
    nodes, forces = touched(cube)
    table = SeriesTable.empty(cube)
    assert not table.has(np.arange(3)).any()
    np.testing.assert_array_equal(table.displacements(nodes, forces), cube.deform(nodes, forces))


def test_an_entry_that_is_put_again_is_drawn_anew(cube):
    place = cube.free_index(touched(cube)[0])[:1]
    solid, table = SeriesSolid(FreeSolid.of(cube)), SeriesTable.empty(cube)
    freedom = freedoms(place)[:1]
    entries = series_entries(solid, freedom)
    table.put(freedom, entries)
    earlier = table.columns(int(freedom[0]))
    polished = replace(entries, second=2.0 * entries.second)
    table.put(freedom, polished)
    fresh = SeriesTable.empty(cube)
    fresh.put(freedom, polished)
    drawn = table.columns(int(freedom[0]))
    np.testing.assert_array_equal(drawn, fresh.columns(int(freedom[0])))
    assert not np.array_equal(drawn, earlier)


def test_what_does_not_move_needs_nothing(cube, whole_load):
    shape = SeriesShape(cube, whole_load=whole_load)
    pinned, force = cube.fixed[:1], np.ones((1, 3))
    shape.wait_for(pinned)
    assert shape.ready == 1.0
    assert not shape.displacements(pinned, force).any()
    shape.close()


def test_what_ends_the_background_is_told_where_it_is_drawn(cube, whole_load, monkeypatch):
    def fails(_):
        raise PalpateError("stiffness: not held")

    monkeypatch.setattr(FreeSolid, "of", fails)
    shape = SeriesShape(cube, whole_load=whole_load)
    nodes, forces = touched(cube)
    with pytest.raises(PalpateError, match="not held"):
        shape.wait_for(nodes)
    with pytest.raises(PalpateError, match="shape series: stiffness: not held"):
        shape.displacements(nodes, forces)
    shape.close()


def test_a_table_is_kept_beside_the_body_and_found_again(cube, tmp_path):
    nodes, forces = touched(cube)
    first = made(cube, False, tmp_path / "cube.npz")
    drawn = first.displacements(nodes, forces)
    first.close()
    first.close()
    assert table_path(tmp_path / "cube.npz", "series").exists()
    stored = SeriesTable.load(cube, table_path(tmp_path / "cube.npz", "series"))
    assert stored.has(cube.free_index(nodes)).all()
    np.testing.assert_array_equal(
        stored.displacements(nodes, forces), first.table.displacements(nodes, forces)
    )
    again = made(cube, False, tmp_path / "cube.npz")
    np.testing.assert_array_equal(again.displacements(nodes, forces), drawn)
    again.close()
    np.testing.assert_array_equal(stored.bound, first.table.bound)


def test_a_whole_table_is_filled_when_asked(cube, tmp_path):
    shape = made(cube, False, tmp_path / "cube.npz")
    shape.finish()
    assert shape.table.is_filled.all()
    assert (shape.table.bound < 0.015).all()
    shape.close()
    again = made(cube, False, tmp_path / "cube.npz")
    assert again.table.is_filled.all()
    again.close()


def test_a_damaged_or_foreign_file_is_told_and_filled_anew(cube, tmp_path):
    path = table_path(tmp_path / "cube.npz", "series")
    nodes, forces = touched(cube)
    clean = made(cube, False)
    right = clean.displacements(nodes, forces)
    clean.close()
    softer = SoftBody(cube.mesh, cube.fixed, 0.3, cube.compliance, cube.young_modulus)
    foreign = SeriesTable.empty(softer)
    foreign.save(path)
    with pytest.raises(TableFileError, match="another body"):
        SeriesTable.load(cube, path)
    shape = made(cube, False, tmp_path / "cube.npz")
    assert "another body" in shape.notice
    np.testing.assert_array_equal(shape.displacements(nodes, forces), right)
    shape.close()
    assert SeriesTable.load(cube, path).has(cube.free_index(nodes)).all()


def test_a_place_that_cannot_be_written_is_a_warning(cube, tmp_path):
    (tmp_path / "file").write_text("")
    shape = made(cube, False, tmp_path / "file" / "cube.npz")
    shape.close()
    assert "cannot be written" in shape.notice


def test_youngs_modulus_is_live(cube, whole_load):
    nodes, forces = touched(cube)
    shape = made(cube, whole_load)
    soft = shape.displacements(nodes, forces, 5_000.0)
    np.testing.assert_allclose(soft, shape.displacements(nodes, 2 * forces, 10_000.0), rtol=1e-12)
    shape.close()


def test_more_that_another_program_kept_meanwhile_is_not_lost(cube, tmp_path):
    more, less = (SeriesShape(cube, tmp_path / "cube.npz", False) for _ in range(2))
    more.finish()
    less.wait_for(touched(cube)[0])
    more.close()
    less._is_filled[-1] = False
    less.close()
    kept = SeriesTable.load(cube, table_path(tmp_path / "cube.npz", "series"))
    assert kept.is_filled.all()
