"""Fit of a body to its mesh, and what is said of a bad one."""

from dataclasses import asdict

import numpy as np
import pytest
import trimesh

from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.errors import PalpateError
from palpate.core.mesh.fit import (
    Fit,
    fit_warnings,
    measured_fit,
    refuse_misfit,
    refuse_thin,
    size_warnings,
)
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.mesh.tetrahedralize import tetrahedralize
from palpate.core.quantities import length, volume
from palpate.core.stiffness.pins import PinBelow

SCALES = [1e-6, 1.0, 1e6]


def surface_of(mesh, scale=1.0):
    return Surface.checked(scale * mesh.vertices, mesh.faces)


def box(low, high):
    """A box of 12 triangles between two corners."""
    return trimesh.creation.box(bounds=np.array([low, high], dtype=float))


@pytest.mark.parametrize("scale", SCALES)
def test_a_body_that_fills_more_than_its_mesh_is_measured_from_the_body(scale):
    cube, _ = paper_cube()
    # Its lid lies a fifth lower, in one large face that no vertex is in the middle of.
    lower = surface_of(box([0, 0, 0], [0.05, 0.05, 0.04]), scale)
    fit = measured_fit(TetMesh.checked(scale * cube.nodes, cube.tets), lower, lower)
    assert fit.body_to_input == pytest.approx(0.01 * scale)
    assert fit.body_at.z == pytest.approx(0.05 * scale)
    assert lower.vertices[fit.body_at.vertex, 2] == pytest.approx(0.04 * scale)
    assert fit.volume_ratio == pytest.approx(1.25)


@pytest.mark.parametrize("scale", SCALES)
def test_a_fin_that_the_body_lacks_is_found_in_the_middle_of_its_triangles(scale):
    cube, _ = paper_cube()
    # A hoop: it leaves the body and comes back, so that its far end is in no vertex's middle.
    points = np.array([[0, 0, 0.05], [0.05, 0, 0.05], [0.025, 0, 0.09], [0.025, 1e-3, 0.09]])
    fin = np.array([[0, 1, 2], [1, 0, 3]])
    block = box([0, 0, 0], [0.05, 0.05, 0.05])
    both = Surface.checked(
        scale * np.vstack([block.vertices, points]), np.vstack([block.faces, fin + 8])
    )
    fit = measured_fit(TetMesh.checked(scale * cube.nodes, cube.tets), both, both)
    assert fit.input_to_body == pytest.approx(0.04 * scale)
    assert fit.input_at.vertex in {10, 11}
    assert fit.body_to_input < 1e-9 * scale
    told = fit_warnings(fit, TetMesh.checked(scale * cube.nodes, cube.tets), both, 0.003)
    (warning,) = [words for words in told if "the mesh lies" in words]
    assert f"vertex {fit.input_at.vertex}" in warning
    assert length(0.04 * scale) in warning


def test_walls_inside_the_body_do_not_count():
    cube, _ = paper_cube()
    inner = trimesh.util.concatenate(
        [box([0, 0, 0], [0.05, 0.05, 0.05]), box([0.02, 0.02, 0.02], [0.03, 0.03, 0.03])]
    )
    fit = measured_fit(cube, surface_of(inner), surface_of(inner))
    assert fit.input_to_body < 1e-9


@pytest.mark.parametrize("scale", [1e-3, 1.0])
def test_an_open_shell_is_warned_of_with_the_place(tmp_path, monkeypatch, scale):
    # A beetle's shell: half a ball without its underside, which the body fills.
    monkeypatch.chdir(tmp_path)
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.1)
    ball.update_faces(ball.triangles_center[:, 2] > 0)
    shell = surface_of(ball, scale)
    body, report = bake(shell, BakeSettings(edge_length=0.1, epsilon=0.005))
    (warning,) = [words for words in report.warnings if "the body lies" in words]
    assert warning.values["distance"] == length(report.fit.body_to_input)
    assert 0.06 * scale < report.fit.body_to_input < 0.11 * scale
    place = report.fit.body_at
    assert np.hypot(place.x, place.y) < 0.05 * scale
    assert abs(place.z) < 0.02 * scale
    assert body.fit == report.fit


def test_a_fit_survives_files():
    cube, _ = paper_cube()
    block = surface_of(box([0, 0, 0], [0.05, 0.05, 0.05]))
    fit = measured_fit(cube, block, block)
    assert Fit.of_dict(asdict(fit)) == fit
    assert Fit.of_array(fit.as_array()) == fit
    for damaged in (np.zeros(10), np.zeros(11, dtype="U3"), np.full(11, np.nan)):
        with pytest.raises(PalpateError):
            Fit.of_array(damaged)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("sections", [4, 12])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_needle_is_told_that_it_is_thinner_than_the_tolerance(scale, sections, turn):
    needle = trimesh.creation.cylinder(radius=0.0002, height=0.2, sections=sections)
    needle.apply_transform(trimesh.transformations.rotation_matrix(turn, [0.3, 0.8, 0.1]))
    with pytest.raises(PalpateError, match=r"thin for a tolerance of .*; use a tolerance") as told:
        tetrahedralize(surface_of(needle, scale), 0.05, 0.003)
    assert "hole" not in str(told.value)
    # The tolerance that it is told is one that keeps it.
    refuse_thin(surface_of(needle, scale), told.value.sentence.values["fitting"], 3.5)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize(
    ("extents", "thickness"), [((0.2, 0.15, 0.0005), 0.0005), ((0.2, 0.0005, 0.0005), 0.0005)]
)
def test_plates_and_rods_are_as_thick_as_they_are(scale, extents, thickness):
    thin = trimesh.creation.box(extents)
    thin.apply_transform(trimesh.transformations.rotation_matrix(0.6, [0.2, -0.5, 0.4]))
    surface = surface_of(thin, scale)
    assert surface.thickness == pytest.approx(thickness * scale, rel=0.01)
    share = thickness * scale / surface.diagonal
    refuse_thin(surface, 0.98 * share)
    with pytest.raises(PalpateError, match="too thin"):
        refuse_thin(surface, 1.02 * share)


def test_a_needle_in_pieces_is_not_told_about_pins():
    # Two beads where the mesh is a rod.
    rod = surface_of(trimesh.creation.box((0.2, 0.001, 0.001)))
    beads, tets = [], []
    for x in (-0.05, 0.05):
        tets.append(4 * len(beads) + np.arange(4))
        beads.append([x, 0, 0] + 0.03 * np.vstack([np.zeros(3), np.eye(3)]))
    mesh = TetMesh.checked(np.vstack(beads), np.vstack(tets))
    fit = measured_fit(mesh, rod, rod)
    with pytest.raises(PalpateError, match="thin for a tolerance"):
        refuse_misfit(fit, mesh, rod, 0.003)
    assert any("2 pieces" in words for words in fit_warnings(fit, mesh, rod, 1e-4))


def test_errors_later_in_a_bake_name_the_misfit(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.05)
    bowl = ball.copy()
    bowl.update_faces(bowl.triangles_center[:, 2] < -0.03)
    settings = BakeSettings(edge_length=0.12, epsilon=0.01, pins=PinBelow(1.0))
    with pytest.raises(PalpateError, match=r"every surface node is pinned.*a likely reason: the"):
        bake(surface_of(bowl), settings)


@pytest.mark.parametrize(
    ("size", "said"), [(2e3, "2 km"), (2e-6, "2 µm"), (0.1, None), (1.0, None), (5.0, None)]
)
def test_a_body_of_unlikely_size_is_told_about_units(size, said):
    cube, _ = paper_cube(edge=size / np.sqrt(3))
    told = size_warnings(cube)
    assert bool(told) == bool(said)
    if said:
        assert said in told[0]
        assert "Unit Scale" in told[0]
        assert "metres per unit" in told[0]
        # A panel shows it, too, where a command line's words say nothing.
        assert "--" not in told[0]


def test_lengths_and_volumes_are_said_in_fitting_units():
    assert [length(x) for x in (3.3e-6, 0.9996e-3, 0.033, 1.2, 2e3)] == [
        *("3.3 µm", "1 mm", "33 mm", "1.2 m", "2 km")
    ]
    assert [volume(x) for x in (5e-10, 65.4e-6, 2.0)] == ["0.5 mm³", "65.4 cm³", "2 m³"]
