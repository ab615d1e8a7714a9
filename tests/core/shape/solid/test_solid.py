"""The solid against finite differences, rigid motion and the linear K, by every law."""

import numpy as np
import pytest

from palpate.core.law.of_material import law_of
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.solid.solid import solid
from palpate.core.stiffness.assembly import assemble

MATERIALS = [
    (ratio, formulation, law)
    for ratio, formulation in [(0.3, "linear"), (0.45, "smoothed"), (-0.2, "smoothed")]
    for law in (law_of(ratio), StVenantKirchhoff())
]


def stiff_half(mesh):
    return np.where(mesh.nodes[mesh.tets].mean(axis=1)[:, 0] > 0.02, 3.0, 1.0)


@pytest.mark.parametrize(("poisson_ratio", "formulation", "law"), MATERIALS)
def test_the_tangent_at_rest_is_the_linear_stiffness(poisson_ratio, formulation, law):
    mesh, _ = paper_cube(cells=3)
    scale = stiff_half(mesh)
    body = solid(mesh, poisson_ratio, law, formulation, scale)
    linear = assemble(mesh, poisson_ratio, formulation=formulation, young_scale=scale)
    found = body.tangent(np.zeros(mesh.nodes.shape))
    assert abs(found - linear).max() < 1e-13 * abs(linear).max()


@pytest.mark.parametrize(("poisson_ratio", "formulation", "law"), MATERIALS)
def test_forces_and_tangent_are_derivatives(poisson_ratio, formulation, law):
    mesh, _ = paper_cube(cells=3)
    body = solid(mesh, poisson_ratio, law, formulation, stiff_half(mesh))
    chance = np.random.default_rng(3)
    u = 0.003 * chance.standard_normal(mesh.nodes.shape)
    way, step = chance.standard_normal(mesh.nodes.shape), 1e-6
    slope = (body.energy(u + step * way) - body.energy(u - step * way)) / (2 * step)
    assert slope == pytest.approx((body.forces(u) * way).sum(), rel=1e-6)
    difference = (body.forces(u + step * way) - body.forces(u - step * way)) / (2 * step)
    tangent = body.tangent(u)
    change = (tangent @ way.ravel()).reshape(-1, 3)
    assert np.abs(difference - change).max() < 1e-6 * np.abs(change).max()
    assert abs(tangent - tangent.T).max() < 1e-13 * abs(tangent).max()


@pytest.mark.parametrize(("poisson_ratio", "formulation", "law"), MATERIALS)
def test_a_turned_body_is_at_rest_and_a_mirrored_one_is_seen(poisson_ratio, formulation, law):
    mesh, _ = paper_cube(cells=2)
    body = solid(mesh, poisson_ratio, law, formulation)
    c, s = np.cos(2.0), np.sin(2.0)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c, -s], [0, s, c]]
    turned = mesh.nodes @ turn.T - mesh.nodes + [0.1, -0.2, 0.3]
    stiff = abs(body.tangent(np.zeros(mesh.nodes.shape))).max()
    assert np.abs(body.forces(turned)).max() < 1e-12 * stiff
    assert np.allclose(body.terms[0].volume_ratios(turned), 1.0)
    mirrored = mesh.nodes * [-2.0, 0.0, 0.0]
    assert np.allclose(body.terms[0].volume_ratios(mirrored), -1.0)


def test_a_stretched_bar_pulls_as_the_closed_form_says():
    mesh, _ = paper_cube(edge=0.1, cells=2)
    stretch, poisson_ratio = 1.4, 0.25
    # Held to its width: E_11 = (s^2 - 1) / 2, P_11 = s (lambda + 2 mu) E_11.
    moved = mesh.nodes * [stretch - 1, 0.0, 0.0]
    forces = solid(mesh, poisson_ratio, StVenantKirchhoff()).forces(moved)
    confined = (1 - poisson_ratio) / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    expected = 0.1**2 * stretch * confined * (stretch**2 - 1) / 2
    end = mesh.nodes[:, 0] > 0.1 - 1e-9
    assert forces[end, 0].sum() == pytest.approx(expected, rel=1e-12)
