"""Patches of the surface moved as asked, against a solve of the whole body by scikit-fem."""

import numpy as np
import pytest
import skfem
from bodies.baked_body import baked_body
from skfem.models.elasticity import lame_parameters as referee_lame
from skfem.models.elasticity import linear_elasticity

from palpate.core.errors import PalpateError
from palpate.core.grip import held_patch
from palpate.core.grip.held_patch import HeldPatch
from palpate.core.grip.motions import drawn_in, moved, turned
from palpate.core.grip.patch import CORE, Grip, patch_of

MOTIONS = {
    "push": moved([0.001, -0.0005, -0.004]),
    "twist": turned(0.7),
    "pinch": drawn_in(0.4),
}


def surface_normals(mesh):
    i, j, k = (mesh.nodes[mesh.surface_triangles[:, corner]] for corner in range(3))
    normals = np.zeros((len(mesh.surface_nodes), 3))
    np.add.at(normals, mesh.surface_local_triangles, np.cross(j - i, k - i)[:, None, :])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def grip_at(body, at, radius, mirror=None):
    place = body.closest_points.query(np.asarray(at))
    corners = body.mesh.surface_local_triangles[place.triangle[0]]
    normal = place.alpha[0] @ surface_normals(body.mesh)[corners]
    normal /= np.linalg.norm(normal)
    turn = np.eye(3) if mirror is None else mirror
    return Grip(int(place.triangle[0]), place.alpha[0], normal, radius, turn)


def held(body, *grips):
    return HeldPatch.of(body, grips, surface_normals(body.mesh))


def top(body):
    """A place on top of the body, off its middle, (3,)."""
    low, high = body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0)
    return low + [0.55, 0.4, 1.2] * (high - low)


def size(body):
    return float(np.linalg.norm(np.ptp(body.mesh.nodes, axis=0)))


def centre_moved(body, grip, displacements):
    corners = body.mesh.surface_triangles[grip.triangle]
    return grip.alpha @ displacements[body.free_index(corners)]


def field_of(grip, shares, body, places):
    """Motion (k, 3) that is asked of places, written out for each kind."""
    centre, n = grip.centre(body.mesh), grip.normal
    arms = places - centre
    across = arms - np.outer(arms @ n, n)
    return shares[:3] + shares[3] * np.cross(n, arms) - shares[4] * across


@pytest.fixture(scope="module")
def exact_mouse(mouse_mesh):
    return baked_body(*mouse_mesh, 0.3, 1_000.0, dtype=np.float64)


@pytest.mark.parametrize("motion", list(MOTIONS))
def test_all_nodes_are_where_a_solve_of_the_whole_body_has_them(exact_mouse, motion):
    body, shares = exact_mouse, MOTIONS[motion]
    grip = grip_at(body, top(body), 0.12 * size(body))
    answer = held(body, grip).answer(shares, body.young_modulus)
    expected = solved_by_referee(body, grip, shares)[body.compliance.free_surface]
    atol = 1e-8 * np.abs(expected).max()
    np.testing.assert_allclose(answer.displacements, expected, rtol=0, atol=atol)


@pytest.fixture(scope="module")
def free_mouse(mouse_mesh):
    return baked_body(mouse_mesh[0], [], 0.3, 1_000.0, dtype=np.float64)


@pytest.mark.parametrize("motion", ["twist", "pinch"])
def test_a_body_that_nobody_holds_is_bent_as_by_a_solve_of_the_whole(free_mouse, motion):
    body, shares = free_mouse, MOTIONS[motion]
    grip = grip_at(body, top(body), 0.12 * size(body))
    answer = held(body, grip).answer(shares, body.young_modulus)
    # There it goes along with the hand; how it is bent is the same.
    expected = solved_by_referee(body, grip, shares)[body.compliance.free_surface]
    places = body.mesh.nodes[body.compliance.free_surface]
    bent, wanted = (without_motion(places, one) for one in (answer.displacements, expected))
    np.testing.assert_allclose(bent, wanted, rtol=0, atol=1e-7 * np.abs(expected).max())
    largest = np.linalg.norm(answer.forces, axis=1).sum()
    assert np.linalg.norm(answer.forces.sum(axis=0)) <= 1e-9 * largest
    arms = body.mesh.nodes[answer.nodes]
    torque = np.cross(arms, answer.forces).sum(axis=0)
    assert np.linalg.norm(torque) <= 1e-9 * largest * size(body)


def test_what_moves_a_body_that_nobody_holds_takes_no_force(free_mouse):
    grip = grip_at(free_mouse, top(free_mouse), 0.12 * size(free_mouse))
    patch = held(free_mouse, grip)
    drawn = np.abs(patch.answer(drawn_in(0.4), 1.0).displacements).max()
    assert np.abs(patch.answer(moved([0.01, 0.0, 0.01]), 1.0).displacements).max() < 1e-9 * drawn


def without_motion(places, displacements):
    """Displacements (n, 3) without the rigid motion nearest to them."""
    arms = places - places.mean(axis=0)
    turns = [np.cross(axis, arms) for axis in np.eye(3)]
    moves = [np.broadcast_to(axis, arms.shape) for axis in np.eye(3)]
    rigid = np.stack([*moves, *turns], axis=-1).reshape(-1, 6)
    share = np.linalg.lstsq(rigid, displacements.ravel(), rcond=None)[0]
    return displacements - (rigid @ share).reshape(-1, 3)


def solved_by_referee(body, grip, shares):
    """Displacements (N, 3): the core by Dirichlet values, the rim by springs to its hand."""
    mesh = body.mesh
    tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
    basis = skfem.Basis(tets, skfem.ElementVector(skfem.ElementTetP1()), intorder=1)
    lame = referee_lame(body.young_modulus, body.poisson_ratio)
    order = basis.nodal_dofs.T.ravel()
    stiffness = linear_elasticity(*lame).assemble(basis).tocsr()[order][:, order].tolil()
    patch = patch_of(body, grip, surface_normals(mesh))
    nodes = mesh.surface_nodes[patch.nodes]
    asked = field_of(grip, shares, body, mesh.nodes[nodes])
    load, found = np.zeros((len(mesh.nodes), 3)), np.zeros((len(mesh.nodes), 3))
    held_fast = list(body.fixed)
    for node, firmness, motion in zip(nodes, patch.firmness, asked, strict=True):
        if firmness == 1.0:
            found[node] = motion
            held_fast.append(node)
            continue
        area = 0.0
        for corners in mesh.nodes[mesh.surface_triangles[(mesh.surface_triangles == node).any(1)]]:
            area += np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) / 6
        spring = body.young_modulus * area / (patch.radius * (1 / firmness - 1))
        load[node] = spring * motion
        for axis in range(3):
            stiffness[3 * node + axis, 3 * node + axis] += spring
    dofs = (3 * np.unique(held_fast)[:, None] + np.arange(3)).ravel()
    system = skfem.condense(stiffness.tocsc(), load.ravel(), found.ravel(), D=dofs)
    return np.asarray(skfem.solve(*system)).reshape(-1, 3)


@pytest.mark.parametrize("radius", [1e-4, 0.05, 0.2])
@pytest.mark.parametrize("motion", list(MOTIONS))
def test_the_core_moves_exactly_as_asked(body, motion, radius):
    grip = grip_at(body, top(body), radius * size(body))
    answer = held(body, grip).answer(MOTIONS[motion], body.young_modulus)
    centre = grip.centre(body.mesh)
    places = body.mesh.nodes[body.compliance.free_surface]
    in_core = np.linalg.norm(places - centre, axis=1) < CORE * grip.radius
    asked = field_of(grip, MOTIONS[motion], body, places[in_core])
    most = np.abs(field_of(grip, MOTIONS[motion], body, places)).max()
    np.testing.assert_allclose(answer.displacements[in_core], asked, rtol=0, atol=1e-4 * most)
    now = centre_moved(body, grip, answer.displacements)
    np.testing.assert_allclose(now, MOTIONS[motion][:3], rtol=0, atol=1e-4 * most)


def test_the_smallest_radius_still_moves_a_patch(body):
    grip = grip_at(body, top(body), 1e-9)
    displacements = held(body, grip).answer(moved(-0.01 * grip.normal), 1.0).displacements
    lengths = np.sort(np.linalg.norm(displacements, axis=1))[::-1]
    assert lengths[0] < 1.1 * lengths[2]
    assert lengths[6] > 0.2 * lengths[0]


def test_two_motions_are_reciprocal(body):
    one = held(body, grip_at(body, top(body), 0.1 * size(body)))
    low, high = body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0)
    two = held(body, grip_at(body, low + [1.1, 0.5, 0.6] * (high - low), 0.15 * size(body)))
    a, b = one.answer(MOTIONS["push"], 1.0), two.answer(moved([0.002, 0.003, 0.001]), 1.0)
    through_b = float((a.forces * b.displacements[one.nodes]).sum())
    through_a = float((b.forces * a.displacements[two.nodes]).sum())
    assert through_a == pytest.approx(through_b, rel=1e-4)
    assert abs(through_a) > 0.01 * a.work


def test_the_force_is_the_slope_of_the_energy_and_a_turn_has_torque(body):
    grip = grip_at(body, top(body), 0.1 * size(body))
    patch = held(body, grip)
    push = patch.answer(moved(-0.004 * grip.normal), 1000.0)
    double = patch.answer(moved(-0.008 * grip.normal), 1000.0)
    assert double.work == pytest.approx(4 * push.work)
    # The rest is in the hand's soft rim.
    assert 0.5 < push.work / (-0.5 * 0.004 * (push.force @ grip.normal)) <= 1.0
    turn = patch.answer(turned(0.3), 1000.0)
    assert turn.torque > 0.0
    assert patch.answer(turned(-0.3), 1000.0).torque == pytest.approx(-turn.torque, rel=0.5)


def test_mirrored_grips_move_mirrored(cube):
    low, high = cube.mesh.nodes.min(axis=0), cube.mesh.nodes.max(axis=0)
    middle = 0.5 * (low + high)
    mirror = np.diag([-1.0, 1.0, 1.0])
    at = low + [0.2, 0.5, 1.1] * (high - low)
    grips = (
        grip_at(cube, at, 0.01),
        grip_at(cube, middle + (at - middle) @ mirror, 0.01, mirror),
    )
    by = np.array([0.002, 0.001, -0.003])
    displacements = held(cube, *grips).answer(moved(by), 1.0).displacements
    for grip, expected in zip(grips, (by, mirror @ by), strict=True):
        now = centre_moved(cube, grip, displacements)
        np.testing.assert_allclose(now, expected, rtol=0, atol=1e-5 * 0.004)


def test_on_the_plane_of_the_mirror_nothing_goes_sideways(cube):
    low, high = cube.mesh.nodes.min(axis=0), cube.mesh.nodes.max(axis=0)
    mirror = np.diag([-1.0, 1.0, 1.0])
    at = low + [0.5, 0.5, 1.1] * (high - low)
    grips = (grip_at(cube, at, 0.01), grip_at(cube, at, 0.01, mirror))
    displacements = held(cube, *grips).answer(moved([0.005, 0.0, -0.003]), 1.0).displacements
    now = centre_moved(cube, grips[0], displacements)
    np.testing.assert_allclose(now, [0.0, 0.0, -0.003], rtol=0, atol=1e-7)


def test_a_large_patch_in_cells_moves_as_one_of_single_nodes(mouse, monkeypatch):
    grip = grip_at(mouse, top(mouse), 0.3 * size(mouse))
    whole = held(mouse, grip).answer(MOTIONS["push"], 1.0)
    monkeypatch.setattr(held_patch, "MOST_CELLS", len(whole.nodes) // 3)
    few = held(mouse, grip).answer(MOTIONS["push"], 1.0)
    monkeypatch.setattr(held_patch, "MOST_READ", len(whole.nodes) // 2)
    thin = held(mouse, grip).answer(MOTIONS["push"], 1.0)
    most = np.linalg.norm(whole.displacements, axis=1).max()
    assert np.linalg.norm(few.displacements - whole.displacements, axis=1).max() < 0.1 * most
    assert np.linalg.norm(thin.displacements - whole.displacements, axis=1).max() < 0.2 * most
    assert np.linalg.norm(few.force) == pytest.approx(np.linalg.norm(whole.force), rel=0.05)


def test_beside_pins_the_hold_gives_way(body):
    lowest = body.mesh.nodes[body.fixed].mean(axis=0)
    surface = body.mesh.nodes[body.compliance.free_surface]
    beside = surface[np.argmin(np.linalg.norm(surface - lowest, axis=1))]
    near = held(body, grip_at(body, beside, 0.1 * size(body))).answer(MOTIONS["push"], 1.0)
    far = held(body, grip_at(body, top(body), 0.1 * size(body))).answer(MOTIONS["push"], 1.0)
    assert np.isfinite(near.displacements).all()
    assert np.linalg.norm(near.force) < 20 * np.linalg.norm(far.force)


def test_a_pinned_place_is_refused(cube):
    middle = cube.mesh.nodes[cube.fixed].mean(axis=0)
    with pytest.raises(PalpateError, match="pinned"):
        held(cube, grip_at(cube, middle, 0.002))
