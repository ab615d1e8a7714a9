import numpy as np
import pytest
import trimesh

from palpate.core.errors import PalpateError
from palpate.core.mesh.decimate import decimate
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.winding_volume import enclosed_volume, winding_numbers


def surface_of(mesh):
    return Surface.checked(mesh.vertices, mesh.faces)


def soup_of(mesh):
    """The same triangles without shared vertices, as after exporting with split normals."""
    return Surface.checked(
        np.asarray(mesh.triangles).reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3)
    )


@pytest.fixture(scope="module")
def ball():
    return trimesh.creation.icosphere(subdivisions=3, radius=0.05)


@pytest.mark.parametrize(
    ("vertices", "triangles", "said"),
    [
        (np.empty((0, 3)), np.empty((0, 3)), "nothing to make soft"),
        (np.eye(3), np.empty((0, 3)), "nothing to make soft"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], "not finite"),
        (np.eye(3), [[0, 1, 5]], "names vertex 5"),
        (np.zeros((3, 3)), [[0, 1, 2]], "zero area"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2]], "flat"),
    ],
)
def test_what_cannot_become_a_solid_is_refused_with_the_reason(vertices, triangles, said):
    with pytest.raises(PalpateError, match=said):
        Surface.checked(vertices, triangles)


def test_openness_is_net_area_over_area(ball):
    assert surface_of(ball).openness == pytest.approx(0, abs=1e-12)
    height, radius = np.cos(np.pi / 6), 0.5
    cone = trimesh.creation.cone(radius, height, sections=200)
    side = cone.submesh([np.flatnonzero(cone.triangles_center[:, 2] > 1e-9)], append=True)
    # Of a cone without its base: radius over slant.
    assert surface_of(side).openness == pytest.approx(radius / np.hypot(radius, height), rel=1e-3)


def test_welding_closes_seams_that_only_look_open(ball):
    soup = soup_of(ball)
    assert not soup.is_closed
    welded = soup.welded()
    assert welded.is_closed
    assert len(welded.vertices) == len(ball.vertices)
    assert welded.signed_volume == pytest.approx(ball.volume)


def test_pieces_are_counted(ball):
    other = ball.copy()
    other.apply_translation([0.2, 0, 0])
    assert surface_of(ball).piece_count == 1
    assert surface_of(trimesh.util.concatenate([ball, other])).piece_count == 2


def test_winding_number_is_one_inside_and_zero_outside(ball):
    numbers = winding_numbers(
        np.array([[0, 0, 0], [0, 0.03, 0.01], [0, 0, 0.06]]), surface_of(ball)
    )
    np.testing.assert_allclose(numbers, [1, 1, 0], atol=1e-9)


def test_volume_of_overlapping_parts_counts_the_overlap_once(ball):
    other = ball.copy()
    other.apply_translation([0.05, 0, 0])
    both = surface_of(trimesh.util.concatenate([ball, other]))
    # The lens shared by two balls at a distance of one radius.
    lens = np.pi * (4 * 0.05 + 0.05) * (2 * 0.05 - 0.05) ** 2 / 12
    exact = 2 * 4 / 3 * np.pi * 0.05**3 - lens
    assert enclosed_volume(both) == pytest.approx(exact, rel=0.03)


@pytest.mark.parametrize("inverted", [False, True])
def test_volume_of_a_closed_piece_is_exact_whichever_way_its_normals_point(ball, inverted):
    mesh = ball.copy()
    if inverted:
        mesh.invert()
    assert enclosed_volume(surface_of(mesh)) == pytest.approx(ball.volume)


def test_decimation_keeps_the_shape_and_reaches_the_number():
    dense = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
    coarse = decimate(surface_of(dense), 4000)
    assert 0.9 * 4000 <= len(coarse.triangles) <= 4000
    assert coarse.is_closed
    assert coarse.signed_volume == pytest.approx(dense.volume, rel=0.005)


@pytest.mark.parametrize("centre", [0.0, 3.0])
def test_the_slivers_at_the_poles_of_a_fine_sphere_do_not_tear_it_out_of_shape(centre):
    dense = trimesh.creation.uv_sphere(radius=0.05, count=[200, 400])
    dense.apply_translation([centre, 0.0, 0.0])
    coarse = decimate(surface_of(dense), 4000)
    assert len(coarse.triangles) < 20_000
    assert np.abs(np.linalg.norm(coarse.vertices - [centre, 0, 0], axis=1) - 0.05).max() < 5e-4


def test_a_small_surface_is_not_decimated(ball):
    surface = surface_of(ball)
    assert decimate(surface, 6000) is surface
