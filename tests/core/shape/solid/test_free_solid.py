"""A pinned body: forces and tangent of its free nodes, and solves with the factored stiffness."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.errors import PalpateError
from palpate.core.law.of_material import law_of
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.solid import solid
from palpate.core.stiffness.freedoms import freedoms


@pytest.fixture(params=["linear", "smoothed"])
def body(request):
    mesh, fixed = paper_cube(cells=3)
    scale = np.where(mesh.nodes[mesh.tets].mean(axis=1)[:, 0] > 0.02, 3.0, 1.0)
    return baked_body(mesh, fixed, formulation=request.param, young_scale=scale, dtype=np.float64)


def test_free_nodes_feel_what_the_whole_body_does(body):
    found = FreeSolid.of(body)
    whole = solid(body.mesh, 0.3, law_of(0.3), body.formulation, body.young_scale)
    u = np.zeros(body.mesh.nodes.shape)
    chance = np.random.default_rng(4)
    u[found.free] = 0.002 * chance.standard_normal((found.node_count, 3))
    free, own = freedoms(found.free), u[found.free]
    assert found.energy(own) == pytest.approx(whole.energy(u), rel=1e-14)
    assert np.allclose(found.forces(own), whole.forces(u)[found.free], rtol=0, atol=1e-15)
    inside = whole.tangent(u)[free][:, free]
    assert abs(found.solid.tangent(own) - inside).max() < 1e-14 * abs(inside).max()
    ratios = (one.terms[0].volume_ratios(moved) for one, moved in [(found.solid, own), (whole, u)])
    assert np.array_equal(*ratios)


def test_linear_displacements_of_the_surface_are_those_of_the_compliance(body):
    found = FreeSolid.of(body)
    nodes = body.mesh.surface_triangles[40]
    forces = np.random.default_rng(5).standard_normal((3, 3))
    inner = found.linear(found.on_free_nodes(nodes, forces))
    expected = body.deform(nodes, forces, 1.0)
    assert np.abs(inner[found.surface] - expected).max() < 1e-9 * np.abs(expected).max()


def test_forces_add_up_on_one_node_and_vanish_on_pins(body):
    found = FreeSolid.of(body)
    node, last_pin = int(found.free[5]), int(body.fixed[-1])
    forces = found.on_free_nodes(
        np.array([node, last_pin, node]), np.array([[1.0, 0, 0], [0, 5, 0], [0, 0, 2]])
    )
    assert forces[5].tolist() == [1, 0, 2]
    assert np.abs(forces).sum() == 3


def test_a_body_that_its_pins_do_not_hold_is_refused(body):
    on_an_edge = body.fixed[body.mesh.nodes[body.fixed, 0] == 0.0]
    for pins in (body.fixed[:1], on_an_edge):
        with pytest.raises(PalpateError, match="could move away; pin at least three"):
            FreeSolid.of(replace(body, fixed=pins))
