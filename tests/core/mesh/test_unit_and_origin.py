"""The same body in every unit and at every origin: what fTetWild is given, and what it gives."""

import numpy as np
import pytest
import pytetwild.pytetwild
import trimesh
from bodies.fan_blade import fan_blade

from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import touch_nearest
from palpate.core.errors import PalpateError
from palpate.core.mesh.coordinates import refuse_rounded
from palpate.core.mesh.decimate import decimate
from palpate.core.mesh.fit import measured_fit
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.mesh.tetrahedralize import tetrahedralize
from palpate.core.mesh.winding_volume import sampled_volume
from palpate.core.stiffness.pins import PinBelow, PinNodes, pinned_nodes

UNITS = [10.0**power for power in range(-6, 7)]
OFFSETS = [1e2, 1e5, 1e8]


def moved(surface, unit=1.0, offset=0.0):
    """In another unit, and elsewhere."""
    away = offset * np.array([1.0, -0.7, 0.3])
    return Surface.checked(unit * surface.vertices + away, surface.triangles)


@pytest.fixture
def given(monkeypatch):
    """What fTetWild is handed; it answers with one tetrahedron."""
    calls = []

    def note(vertices, triangles, **_):
        calls.append((vertices.copy(), triangles.copy()))
        return np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]])

    monkeypatch.setattr(pytetwild.pytetwild, "tetrahedralize", note)
    return calls


def test_the_mesher_gets_the_same_bytes_in_every_unit(given):
    blade = fan_blade()
    for unit in UNITS:
        tetrahedralize(moved(blade, unit).welded(), 0.05, 0.003)
    vertices, triangles = given[0]
    assert np.linalg.norm(np.ptp(vertices, axis=0)) == pytest.approx(1, abs=1e-9)
    for others, same in given[1:]:
        np.testing.assert_array_equal(others, vertices)
        np.testing.assert_array_equal(same, triangles)


def test_the_mesher_gets_neighbours_together_in_whatever_order_they_come(given):
    blade = fan_blade().welded()
    rng = np.random.default_rng(15)
    for _ in range(2):
        shuffled = rng.permutation(blade.triangles)
        tetrahedralize(Surface.checked(blade.vertices, shuffled), 0.05, 0.003)
    vertices, triangles = given[0]
    np.testing.assert_array_equal(given[1][1], triangles)
    steps = np.linalg.norm(np.diff(vertices[triangles].mean(axis=1), axis=0), axis=1)
    scattered = np.linalg.norm(np.diff(vertices[shuffled].mean(axis=1), axis=0), axis=1)
    assert steps.mean() < 0.5 * scattered.mean()


@pytest.mark.parametrize("offset", OFFSETS)
def test_the_mesher_gets_the_same_shape_at_every_origin(given, offset):
    blade = fan_blade()
    tetrahedralize(blade.welded(), 0.05, 0.003)
    tetrahedralize(moved(blade, offset=offset).welded(), 0.05, 0.003)
    (here, _), (there, _) = given
    # Both ends of a length are rounded where they are, and the middle.
    rounding = 4 * np.spacing(offset) / blade.diagonal
    np.testing.assert_allclose(there, here, rtol=0, atol=max(rounding, 1e-9))


@pytest.mark.parametrize("offset", [0.0, *OFFSETS])
@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_decimation_depends_on_neither(unit, offset):
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
    here = decimate(Surface.checked(ball.vertices, ball.faces), 1000)
    surface = moved(Surface.checked(ball.vertices, ball.faces), unit, unit * offset / 1e3)
    there = decimate(surface, 1000)
    assert len(there.triangles) == len(here.triangles)
    far = np.linalg.norm((there.vertices - unit * offset / 1e3 * np.array([1, -0.7, 0.3])), axis=1)
    assert np.abs(far / unit - 0.05).max() < 0.002


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e-2, 1.0, 1e3, 1e6])
def test_tetrahedra_are_as_near_in_every_unit(tmp_path, monkeypatch, unit):
    refuse_far(tmp_path, monkeypatch, moved(fan_blade(), unit))


@pytest.mark.parametrize("offset", OFFSETS)
def test_tetrahedra_are_as_near_at_every_origin(tmp_path, monkeypatch, offset):
    refuse_far(tmp_path, monkeypatch, moved(fan_blade(), offset=offset))


def refuse_far(folder, monkeypatch, surface):
    # fTetWild writes files into the working directory.
    monkeypatch.chdir(folder)
    shell = surface.welded()
    mesh = tetrahedralize(shell, 0.1, 0.005)
    fit = measured_fit(mesh, surface, shell)
    assert fit.body_to_input < 0.007 * surface.diagonal
    assert fit.input_to_body < 0.007 * surface.diagonal
    assert fit.volume_ratio == pytest.approx(1, abs=0.01)
    bottom = pinned_nodes(PinBelow(0.1), mesh, surface)
    height = mesh.nodes[:, 2] - mesh.nodes[:, 2].min()
    assert len(bottom) > 10
    assert height[bottom].max() <= 0.11 * height.max()


@pytest.mark.parametrize("offset", OFFSETS)
def test_volume_and_seams_do_not_depend_on_the_origin(offset):
    blade = fan_blade()
    soup = Surface.checked(
        blade.vertices[blade.triangles].reshape(-1, 3), np.arange(92 * 3).reshape(-1, 3)
    )
    there = moved(soup, offset=offset).welded()
    assert there.is_closed
    assert there.signed_volume == pytest.approx(blade.signed_volume, rel=1e-5)


def test_all_of_a_level_bottom_is_pinned_far_from_the_origin():
    cube, fixed = paper_cube()
    nodes = cube.nodes + np.array([0, 0, 1e8])
    nodes[fixed[::2], 2] = np.nextafter(nodes[fixed[::2], 2], np.inf)
    far = TetMesh.checked(nodes, cube.tets)
    np.testing.assert_array_equal(pinned_nodes(PinBelow(0.0), far, None), fixed)


@pytest.mark.parametrize("form", ["dense", "compressed"])
@pytest.mark.parametrize(
    ("unit", "offset"), [(1e-6, 0.0), (1e-3, 0.0), (1e3, 0.0), (1e6, 0.0), (1.0, 1e5), (1e6, 1e8)]
)
def test_a_press_feels_the_same_in_every_unit_and_at_every_origin(form, unit, offset):
    """Force is Young's modulus times length squared times a number of the shape alone."""
    cube, fixed = paper_cube()

    def pressed(unit, away):
        mesh = TetMesh.checked(cube.nodes * unit + away, cube.tets)
        settings = BakeSettings(0.45, 1e5, PinNodes(fixed), form=form)
        touch = touch_nearest(
            bake(mesh, settings)[0],
            at=np.array([0.021, 0.027, 0.05]) * unit + away,
            by=np.array([0.001, 0.0, -0.004]) * unit,
            settings=ContactSettings(friction=0.5),
        )
        return touch.force / unit**2

    here = pressed(1.0, np.zeros(3))
    there = pressed(unit, offset * np.array([1.0, -0.7, 0.3]))
    np.testing.assert_allclose(there, here, rtol=0, atol=1e-6 * np.linalg.norm(here))


def test_a_body_that_its_place_has_left_no_shape_is_refused_with_the_reason():
    cube, _ = paper_cube()
    with pytest.raises(PalpateError, match="detail is lost"):
        TetMesh.checked(cube.nodes * 1e-6 + 1e8, cube.tets)


def test_what_single_precision_has_lost_is_refused():
    vertices = (fan_blade().vertices + 1e5).astype(np.float32)
    with pytest.raises(PalpateError, match="detail is lost"):
        Surface.checked(vertices, fan_blade().triangles)
    Surface.checked(fan_blade().vertices + 1e5, fan_blade().triangles)
    refuse_rounded("mesh", (fan_blade().vertices + 10).astype(np.float32))


def test_a_slanted_rod_has_the_volume_of_an_upright_one():
    rod = trimesh.creation.box((0.2, 0.002, 0.002))
    rod.apply_transform(trimesh.transformations.rotation_matrix(0.5, [0.3, 0.8, 0.1]))
    assert sampled_volume(Surface.checked(rod.vertices, rod.faces)) == pytest.approx(8e-7, rel=0.1)
