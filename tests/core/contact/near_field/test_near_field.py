"""The near field: as a half-space close by, as the finite elements farther away."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.bare_body import bare_body
from bodies.free_shapes import shell_ball

from palpate.core.contact.near_field.compliance_beneath import near_correction
from palpate.core.contact.near_field.contact_points import ContactPoints, contact_points
from palpate.core.contact.near_field.half_space import surface_displacement
from palpate.core.contact.near_field.point_compliance import point_compliance
from palpate.core.contact.near_field.surface_nodes import mean_edges, resolved_lengths
from palpate.core.contact.near_field.surface_shape import node_normals
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh

EDGE = 0.05
TOP = np.array([0.025, 0.025, EDGE])


def body_of(mesh, fixed, nu, formulation="linear", young_scale=None):
    return baked_body(mesh, fixed, nu, 1.0, formulation, young_scale, np.float64)


def cube_of(cells, nu=0.3, formulation="linear", scale=1.0, turn=None):
    mesh, fixed = paper_cube(EDGE, cells)
    nodes = scale * mesh.nodes @ (np.eye(3) if turn is None else turn).T
    return body_of(TetMesh.checked(nodes, mesh.tets), fixed, nu, formulation)


def patch(points, place, radius):
    return np.flatnonzero(np.linalg.norm(points.positions - place, axis=1) < radius)


def matrix(blocks):
    return blocks.transpose(0, 2, 1, 3).reshape(3 * len(blocks), -1)


@pytest.fixture(scope="module")
def cubes():
    return {cells: cube_of(cells) for cells in (4, 8, 12)}


def test_the_correction_is_symmetric(mouse):
    points = contact_points(mouse, 0.004)
    some = patch(points, points.positions[500], 0.014)
    correction = near_correction(mouse, points)
    blocks = matrix(correction.between(some, some))
    assert np.abs(blocks).max() > 0
    np.testing.assert_array_equal(blocks, blocks.T)


def test_what_is_asked_for_again_is_what_it_was(mouse):
    """Pairs are kept from one question to the next, in whatever order they are asked for."""
    points = contact_points(mouse, 0.006)
    first = patch(points, points.positions[500], 0.014)
    later = patch(points, points.positions[first[0]], 0.014)
    assert 0 < len(np.intersect1d(first, later)) < len(later)
    correction = near_correction(mouse, points)
    correction.between(first, first)
    fresh = near_correction(mouse, points).between(later, later)
    np.testing.assert_allclose(correction.between(later, later), fresh, rtol=1e-12)
    mixed = np.concatenate([later[::-1], first[:3]])
    some = correction.between(mixed, mixed)
    np.testing.assert_allclose(some[: len(later), : len(later)], fresh[::-1, ::-1], rtol=1e-12)
    between = correction.between(first, later)
    np.testing.assert_allclose(between[:3], some[-3:, : len(later)][:, ::-1], rtol=1e-12)


def test_far_apart_little_is_added_to_the_finite_elements(mouse):
    points = contact_points(mouse, 0.003)
    # One in the middle of a triangle, where the elements are poorest.
    one = np.array([points.alphas.min(axis=1).argmax()])
    correction = near_correction(mouse, points)
    apart = np.linalg.norm(points.positions - points.positions[one], axis=1)
    share = []
    for least in (0.003, 0.012, 0.04):
        ring = np.flatnonzero((apart > least) & (apart < 1.5 * least))
        added = np.abs(correction.between(one, ring)).max(axis=(0, 2, 3))
        plain = np.abs(point_compliance(mouse, points, one, ring)).max(axis=(0, 2, 3))
        share.append(added.mean() / plain.mean())
    assert share[0] > 5 * share[1] > 25 * share[2] > 0
    assert share[2] < 0.01


def lattice_on_top(body, step, radius):
    """Contact points of one square lattice around the middle of the top face; the first is there.

    Half a step beside a node, as a finger is that does not know the mesh.
    """
    line = np.arange(-np.ceil(radius / step), np.ceil(radius / step) + 1) * step
    x, y = (axis.ravel() for axis in np.meshgrid(line, line))
    within = np.flatnonzero(np.hypot(x, y) < radius)
    within = within[np.argsort(np.hypot(x, y)[within], kind="stable")]
    shift = np.array([0.0007, 0.0003, 0.0])
    places = TOP + shift + np.column_stack([x, y, 0 * x])[within]
    found = body.closest_points.query(places)
    count = len(places)
    return ContactPoints(
        places,
        np.tile([0.0, 0.0, 1.0], (count, 1)),
        found.triangle,
        found.alpha,
        np.full(count, step**2),
    )


def sinking(body, step, radius):
    """How far the middle of a disc gives way per newton spread over it: plain, corrected, exact."""
    points = lattice_on_top(body, step, radius)
    everyone = np.arange(len(points))
    correction = near_correction(body, points)
    plain, near = (
        point_compliance(body, points, everyone[:1], everyone, which)[0, :, 2, 2].mean()
        for which in (None, correction)
    )
    # A lattice covers a disc but roughly: as one of the same area.
    equal = np.sqrt(points.areas.sum() / np.pi)
    return plain, near, 2 * (1 - 0.3**2) / (np.pi * equal)


@pytest.mark.parametrize("cells", [4, 8, 12])
def test_a_small_disc_sinks_as_in_a_half_space(cubes, cells):
    """2 (1 - nu^2) p a, on a disc of an eighth of the coarsest element."""
    plain, near, closed_form = sinking(cubes[cells], 0.0002, 0.0015)
    assert near == pytest.approx(closed_form, rel=0.04)
    assert plain < 0.6 * near


def test_with_a_finer_mesh_there_is_less_and_less_to_correct(cubes):
    """A disc of two thirds of the coarsest element's edge, of two of the finest."""
    plain, near, _ = np.array([sinking(cubes[cells], 0.001, 0.0083) for cells in (4, 8, 12)]).T
    np.testing.assert_allclose(near, near[-1], rtol=0.03)
    missing = 1 - plain / near
    assert missing[0] > 0.25
    assert missing[0] > 2 * missing[1] > 3 * missing[2]
    assert 0 < missing[2] < 0.07


def test_a_point_load_is_felt_afar_as_by_boussinesq(cubes):
    """From one and a half elements on; the block is not infinite and the mesh not isotropic."""
    body, step = cubes[12], EDGE / 12
    places = body.mesh.nodes[body.compliance.free_surface]
    loaded = int(np.argmin(np.linalg.norm(places - TOP, axis=1)))
    offsets = places - TOP
    apart = np.linalg.norm(offsets, axis=1)
    ring = np.flatnonzero((places[:, 2] == EDGE) & (apart > 1.5 * step) & (apart < 3.5 * step))
    moved = body.compliance.blocks(ring, np.array([loaded]))[:, 0, 2, 2]
    up = np.tile([0.0, 0.0, 1.0], (len(ring), 1))
    np.testing.assert_allclose(
        moved, surface_displacement(offsets[ring], up, 0.3)[:, 2, 2], rtol=0.08
    )


def drawn_in(body):
    """How far a push on the top draws in what is around it, mean over places 5, 7 and 9 mm away."""
    turn = np.arange(16) * 2 * np.pi / 16
    ring = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    ways = np.vstack([radius * ring for radius in (0.0, 0.005, 0.007, 0.009)])[15:]
    places = ways + TOP + np.array([0.0007, 0.0003, 0.0])
    found = body.closest_points.query(places)
    up, areas = np.tile([0.0, 0.0, 1.0], (len(places), 1)), np.full(len(places), 1e-6)
    points = ContactPoints(places, up, found.triangle, found.alpha, areas)
    first, others = np.array([0]), np.arange(1, len(places))
    blocks = point_compliance(body, points, others, first, near_correction(body, points))[:, 0]
    return np.einsum("px,px->p", np.tile(ring, (3, 1)), blocks[:, :, 2]).mean()


@pytest.mark.parametrize(("cells", "apart"), [(4, 0.08), (8, 0.04)])
def test_a_push_draws_its_surroundings_in_alike_on_every_mesh(cubes, cells, apart):
    """By what elements say from one edge on, 22 % and 7 % apart, and a third too little."""
    assert drawn_in(cubes[cells]) == pytest.approx(drawn_in(cubes[12]), rel=apart)


@pytest.mark.parametrize(("nu", "formulation"), [(0.3, "linear"), (0.45, "smoothed")])
def test_turning_the_body_turns_the_near_field(nu, formulation):
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    straight = cube_of(4, nu, formulation)
    turned = cube_of(4, nu, formulation, turn=turn)
    points = contact_points(straight, 0.005)
    as_turned = replace(
        points, positions=points.positions @ turn.T, normals=points.normals @ turn.T
    )
    some = patch(points, TOP, 0.012)
    found = [
        near_correction(body, where).between(some, some)
        for body, where in ((straight, points), (turned, as_turned))
    ]
    expected = turn @ found[0] @ turn.T
    np.testing.assert_allclose(found[1], expected, atol=1e-9 * np.abs(expected).max())


def test_a_body_of_twice_the_size_gives_way_half_as_far():
    found = []
    for scale in (1.0, 2.0):
        body = cube_of(4, scale=scale)
        points = contact_points(body, 0.005 * scale)
        some = patch(points, scale * TOP, 0.012 * scale)
        found.append(near_correction(body, points).between(some, some))
    np.testing.assert_allclose(found[0], 2 * found[1], atol=1e-9 * np.abs(found[0]).max())


def test_a_place_of_twice_the_modulus_gives_way_half_as_far(cubes):
    mesh, fixed = paper_cube(EDGE, 4)
    stiff = body_of(mesh, fixed, 0.3, young_scale=np.full(len(mesh.tets), 2.0))
    points = contact_points(stiff, 0.005)
    some = patch(points, TOP, 0.012)
    both = [near_correction(body, points).between(some, some) for body in (cubes[4], stiff)]
    np.testing.assert_allclose(both[0], 2 * both[1], atol=1e-9 * np.abs(both[0]).max())


def test_pinned_places_stay_as_firm_as_they_are(cubes):
    body = cubes[4]
    points = contact_points(body, 0.004)
    low = np.flatnonzero(points.positions[:, 2] == 0)[:60]
    blocks = point_compliance(body, points, low, low, near_correction(body, points))
    firmest = np.linalg.eigvalsh(body.compliance.diagonal()).min()
    assert np.linalg.eigvalsh(matrix(blocks)).min() > 0.05 * firmest
    assert np.einsum("iixx->i", blocks).max() / 3 < 1.11 * firmest


# Where it is thin: edges of both ears, the tail's end, the nose.
THIN = np.array([[45.8, 31.3, 40.7], [36.5, -29.5, 47.1], [-92.3, -2.2, -9.8], [101.2, 4.6, 14.8]])
TAIL = 2


def least_share(whole):
    """Least eigenvalue of a matrix with its diagonal brought to 1."""
    scale = 1 / np.sqrt(np.diag(whole))
    return np.linalg.eigvalsh(whole * scale * scale[:, None])[0]


@pytest.mark.parametrize("formulation", ["linear", "smoothed"])
def test_every_patch_that_a_fingertip_covers_is_positive_definite(mouse_mesh, rng, formulation):
    """On the mouse: points on one side within 0.7 of the radius; pushes also at the tail."""
    mesh, fixed = mouse_mesh
    everywhere, radius = body_of(mesh, fixed, 0.49, formulation), 0.012
    points = contact_points(everywhere, radius / 4)
    thin = np.linalg.norm(points.positions - 1e-3 * THIN[:, None], axis=2).argmin(axis=1)
    centres = np.concatenate([thin, rng.choice(len(points), 25, replace=False)])
    patches = []
    for centre in centres:
        near = patch(points, points.positions[centre], 0.7 * radius)
        patches.append(near[points.normals[near] @ points.normals[centre] > 0.2])
    used, place = np.unique(np.concatenate(patches), return_inverse=True)
    some = points.taken(used)
    correction = near_correction(everywhere, some)
    ends = np.cumsum([len(one) for one in patches])[:-1]
    for number, few in enumerate(np.split(place, ends)):
        blocks = point_compliance(everywhere, some, few, few, correction)
        along = np.einsum("ix,ijxy,jy->ij", some.normals[few], blocks, some.normals[few])
        assert least_share(along) > 0.01
        if formulation == "linear" or number != TAIL:
            assert least_share(matrix(blocks)) > 0.01


def test_no_point_pulls_itself_in_where_pins_are_nearer_than_points(cubes):
    """Cells far larger than the way to the pins: a half-space has nothing to say there."""
    points = contact_points(cubes[12], 0.01)
    vast = replace(points, areas=np.full(len(points), 1.0))
    everyone = np.arange(len(points))
    blocks = point_compliance(cubes[12], vast, everyone, everyone, near_correction(cubes[12], vast))
    assert np.linalg.eigvalsh(np.einsum("iixy->ixy", blocks)).min() > 0


def test_distances_are_told_in_wider_lengths_where_smoothed_elements_meet_an_even_surface(
    mouse_mesh,
):
    def wider(mesh, formulation):
        body = bare_body(mesh, np.empty(0, np.int64), 0.3, formulation)
        return resolved_lengths(body, node_normals(mesh)) / mean_edges(body)

    mesh, _ = mouse_mesh
    places = mesh.nodes[mesh.surface_nodes]
    bent = np.linalg.norm(places - 1e-3 * THIN[:, None], axis=2).argmin(axis=1)
    np.testing.assert_array_equal(wider(mesh, "linear"), 1.0)
    np.testing.assert_array_equal(wider(mesh, "smoothed")[bent], 1.0)
    even, ball = shell_ball(0.03, 500, 1.0), shell_ball(0.03, 500, 1.6)
    flat = TetMesh.checked(ball.nodes * [1.0, 1.0, 0.4], ball.tets)
    np.testing.assert_allclose(wider(even, "smoothed"), 1.23, atol=0.07)
    assert wider(ball, "smoothed").min() > 1.2
    assert wider(ball, "smoothed").mean() > 1.1 * wider(even, "smoothed").mean()
    middle = np.linalg.norm(flat.nodes[flat.surface_nodes, :2], axis=1) < 0.01
    np.testing.assert_array_equal(wider(flat, "smoothed")[middle], 1.0)
