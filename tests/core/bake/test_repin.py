"""Further pins without a bake answer as a bake with these pins does."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.bake import repin
from palpate.core.bake.cost.prediction import estimate_cost
from palpate.core.bake.cost.size import MeshSize
from palpate.core.bake.repin import LARGEST_ERROR, pin_more, pin_more_seconds, pins_change
from palpate.core.bake.settings import BakeSettings
from palpate.core.body import body_file
from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.mapped import MappedCompliance
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble


def baked(body, fixed):
    """The columns of L with these pins by elimination, one a row, float64."""
    stiffness = assemble(
        body.mesh, body.poisson_ratio, formulation=body.formulation, young_scale=body.young_scale
    )
    compliance = surface_compliance(body.mesh, stiffness, fixed, dtype=np.float64)
    return compliance.free_surface, compliance.table.reshape(3 * compliance.node_count, -1)


def largest_error(pinned, exact):
    columns = pinned.compliance.columns(np.arange(pinned.compliance.node_count)).T
    return (np.linalg.norm(columns - exact, axis=1) / np.linalg.norm(exact, axis=1)).max()


def at_ratio(body, poisson_ratio, formulation="linear"):
    stiffness = assemble(body.mesh, poisson_ratio, formulation=formulation)
    compliance = surface_compliance(body.mesh, stiffness, body.fixed)
    return SoftBody(body.mesh, body.fixed, poisson_ratio, compliance, 1e3, formulation)


def choices(body, rng):
    """Nodes to pin besides: one, scattered ones, a patch of neighbours, and most of the surface."""
    free = body.compliance.free_surface
    height = body.mesh.nodes[free, 2]
    return {
        "one": free[:1],
        "scattered": rng.choice(free, 5, replace=False),
        "patch": free[np.argsort(height)[-len(free) // 8 :]],
        "third": rng.choice(free, len(free) * 3 // 10, replace=False),
        "lowest": free[np.argsort(height)[: len(free) // 2]],
        "all but one": free[1:],
    }


def test_more_pins_answer_as_a_bake_with_them(body, rng):
    for added in choices(body, rng).values():
        pinned = pin_more(body, added)
        free_surface, exact = baked(body, pinned.fixed)
        np.testing.assert_array_equal(pinned.fixed, np.union1d(body.fixed, added))
        np.testing.assert_array_equal(pinned.compliance.free_surface, free_surface)
        assert largest_error(pinned, exact) < LARGEST_ERROR
        table = pinned.compliance.table.reshape(exact.shape)
        np.testing.assert_array_equal(table, table.T)


def test_the_key_is_that_of_a_bake_with_the_same_pins(cube):
    added = cube.compliance.free_surface[[4, 9]]
    pinned = pin_more(cube, added)
    assert pinned.key == body_file.body_key(cube.mesh, np.union1d(cube.fixed, added), 0.49)
    assert pinned.young_modulus == cube.young_modulus
    assert cube.compliance.node_count == 73


def test_pinning_twice_is_pinning_at_once(mouse, rng):
    first, second = rng.choice(mouse.compliance.free_surface, (2, 40), replace=False)
    twice = pin_more(pin_more(mouse, first), second)
    _, exact = baked(mouse, twice.fixed)
    assert largest_error(twice, exact) < LARGEST_ERROR
    assert twice.key == pin_more(mouse, np.concatenate([second, first])).key


def test_what_is_pinned_already_and_what_is_named_twice_changes_nothing(cube):
    assert pin_more(cube, cube.fixed) is cube
    assert pin_more(cube, []) is cube
    node = cube.compliance.free_surface[7]
    assert pin_more(cube, [node, node, cube.fixed[0]]).key == pin_more(cube, [node]).key


def test_a_node_inside_asks_for_a_bake(cube):
    inside = np.setdiff1d(np.arange(len(cube.mesh.nodes)), cube.mesh.surface_nodes)[0]
    with pytest.raises(PalpateError, match=f"node {inside} lies inside.*bake"):
        pin_more(cube, [inside])


@pytest.mark.parametrize("node", [-1, 125])
def test_a_node_that_does_not_exist_is_refused(cube, node):
    with pytest.raises(PalpateError, match="is not a node"):
        pin_more(cube, [node])


def test_pinning_everything_is_refused(cube):
    with pytest.raises(PalpateError, match="nothing is left"):
        pin_more(cube, cube.mesh.surface_nodes)


def test_rounding_noise_is_foretold_within_a_factor_of_three(cube, mouse, rng, monkeypatch):
    monkeypatch.setattr(repin, "LARGEST_ERROR", np.inf)
    foretold = []

    def kept(*arguments):
        foretold.append(noise(*arguments))
        return foretold[-1]

    noise = repin._rounding_noise
    monkeypatch.setattr(repin, "_rounding_noise", kept)
    for body in (cube, mouse, at_ratio(cube, 0.4999)):
        pinned = pin_more(body, choices(body, rng)["third"])
        _, exact = baked(body, pinned.fixed)
        found = np.linalg.norm(pinned.compliance.table.reshape(exact.shape) - exact, axis=1)
        ratio = foretold[-1] / found
        assert (ratio > 1 / 3).all()
        assert (ratio < 3).all()


def test_where_rounding_would_show_the_body_is_eliminated_anew(cube, rng):
    body = at_ratio(cube, 0.4999)
    pinned = pin_more(body, choices(body, rng)["third"])
    _, exact = baked(body, pinned.fixed)
    assert largest_error(pinned, exact) < 1e-6


def test_formulation_and_regional_stiffness_stay(cube, rng):
    scale = np.where(cube.mesh.nodes[cube.mesh.tets].mean(axis=1)[:, 0] > 0.025, 100.0, 1.0)
    stiffness = assemble(cube.mesh, 0.49, formulation="smoothed", young_scale=scale)
    compliance = surface_compliance(cube.mesh, stiffness, cube.fixed)
    body = SoftBody(cube.mesh, cube.fixed, 0.49, compliance, 1e4, "smoothed", scale)
    pinned = pin_more(body, choices(body, rng)["patch"])
    _, exact = baked(body, pinned.fixed)
    assert largest_error(pinned, exact) < LARGEST_ERROR
    assert pinned.key == body_file.body_key(cube.mesh, pinned.fixed, 0.49, "smoothed", scale)


def test_a_compressed_body_stays_compressed_and_keeps_its_tolerance(mouse, rng):
    positions = mouse.mesh.nodes[mouse.compliance.free_surface]
    body = replace(mouse, compliance=compress(mouse.compliance, positions, 1e-3))
    pinned = pin_more(body, choices(body, rng)["lowest"])
    _, exact = baked(body, pinned.fixed)
    assert pinned.compliance.form == "compressed"
    assert largest_error(pinned, exact) < 1e-3


def test_a_body_left_in_its_file_can_be_pinned_more(cube, tmp_path):
    body_file.save(cube, tmp_path / "cube.npz")
    body = body_file.load(tmp_path / "cube.npz", mapped_from_bytes=0)
    assert isinstance(body.compliance, MappedCompliance)
    added = cube.compliance.free_surface[:3]
    np.testing.assert_array_equal(
        pin_more(body, added).compliance.table, pin_more(cube, added).compliance.table
    )


def test_two_pieces_stay_apart(cube_mesh):
    mesh, fixed = cube_mesh
    nodes = np.concatenate([mesh.nodes, mesh.nodes + np.array([0.2, 0, 0])])
    both = TetMesh.checked(nodes, np.concatenate([mesh.tets, mesh.tets + len(mesh.nodes)]))
    pins = np.concatenate([fixed, fixed + len(mesh.nodes)])
    compliance = surface_compliance(both, assemble(both, 0.3), pins)
    body = SoftBody(both, pins, 0.3, compliance, 1.0)
    pinned = pin_more(body, compliance.free_surface[:20])
    _, exact = baked(body, pinned.fixed)
    assert largest_error(pinned, exact) < LARGEST_ERROR


def test_what_changed_pins_ask_for(cube):
    inside = np.setdiff1d(np.arange(len(cube.mesh.nodes)), cube.mesh.surface_nodes)[:1]
    free, old = cube.compliance.free_surface, cube.fixed
    for new, wanted in {
        "the same in another order": (old[::-1], "same"),
        "one more": (np.append(old, free[0]), "more"),
        "one less": (old[1:], "bake"),
        "one moved": (np.append(old[1:], free[0]), "bake"),
        "one inside": (np.append(old, inside), "bake"),
    }.values():
        assert pins_change(cube.mesh, old, new) == wanted


def test_the_time_foretold_grows_with_pins_and_is_a_bakes_for_a_compressed_body():
    size, dense = MeshSize(20_000, 3_400), BakeSettings(form="dense")
    few, many = (pin_more_seconds(size, dense, 3_000, added) for added in (1, 1_000))
    assert 0 < few < many
    compressed = BakeSettings(form="compressed")
    assert pin_more_seconds(size, compressed, 3_000, 1) == estimate_cost(size, compressed).seconds


@pytest.mark.parametrize("name", ["cube", pytest.param("mouse", marks=pytest.mark.at_length)])
def test_a_free_body_takes_its_first_pins_as_a_bake_with_them(name, rng, request):
    pinned_before = request.getfixturevalue(name)
    mesh, ratio = pinned_before.mesh, pinned_before.poisson_ratio
    free = baked_body(mesh, [], ratio, 1e4, density=900.0)
    for added in (pinned_before.fixed, *list(choices(free, rng).values())[1:]):
        pins = np.intersect1d(added, mesh.surface_nodes)
        pinned = pin_more(free, pins)
        free_surface, exact = baked(free, pins)
        np.testing.assert_array_equal(pinned.compliance.free_surface, free_surface)
        np.testing.assert_array_equal(pinned.fixed, pins)
        assert largest_error(pinned, exact) < 2e-6
        assert pinned.density == 900.0
        table = pinned.compliance.table.reshape(exact.shape)
        np.testing.assert_array_equal(table, table.T)
    with pytest.raises(PalpateError, match="could move away"):
        pin_more(free, free.mesh.surface_nodes[:2])
    assert pin_more(free, []) is free
