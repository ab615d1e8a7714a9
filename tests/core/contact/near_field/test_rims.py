"""Plates over whole faces of a cube of smoothed elements, beside scikit-fem's quadratic ones."""

import numpy as np
import pytest
from bodies.baked_body import baked_body
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex2, ElementVector, MeshHex
from skfem.models.elasticity import lame_parameters, linear_elasticity

from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.mesh.paper_cube import paper_cube

EDGE, DEPTH = 0.05, 0.001


def force_of_another_program(ratio, cells=4):
    """Of a smooth plate on the whole top of a cube of 1 Pa that is held below, newton.

    A quarter of it, with so many cells along its height and half as many across.
    """
    across, up = np.linspace(0.0, EDGE / 2, cells // 2 + 1), np.linspace(0.0, EDGE, cells + 1)
    basis = Basis(MeshHex.init_tensor(across, across, up), ElementVector(ElementHex2()), intorder=4)
    stiffness = linear_elasticity(*lame_parameters(1.0, ratio)).assemble(basis).tocsc()
    below = basis.get_dofs(lambda x: np.isclose(x[2], 0.0)).all()
    above = basis.get_dofs(lambda x: np.isclose(x[2], EDGE)).all("u^3")
    middles = [
        basis.get_dofs(lambda x, axis=axis: np.isclose(x[axis], 0.0)).all(f"u^{axis + 1}")
        for axis in (0, 1)
    ]
    u = np.zeros(basis.N)
    u[above] = -DEPTH
    free = np.setdiff1d(np.arange(basis.N), np.concatenate([below, above, *middles]))
    u[free] = splu(stiffness[free][:, free]).solve(-(stiffness @ u)[free])
    return -4.0 * (stiffness @ u)[above].sum()


@pytest.fixture(scope="module", params=[0.3, 0.45])
def cubes(request):
    """The ratio, and cubes of smoothed elements by their cells."""
    ratio = request.param
    return ratio, {
        cells: baked_body(*paper_cube(EDGE, cells), ratio, 1.0, formulation="smoothed")
        for cells in (4, 8)
    }


def pressed(body):
    wide = plate(1.2 * EDGE, 1.2 * EDGE)
    return press_tool(body, wide, Pose.at([EDGE / 2, EDGE / 2, EDGE - DEPTH]))


def test_a_plate_over_a_whole_face_is_felt_as_another_program_has_it(cubes):
    ratio, by_cells = cubes
    expected = force_of_another_program(ratio)
    # A coarse cube bends too little as it bulges, by 2 to 4 %.
    for cells, allowed in ((4, 0.08), (8, 0.03)):
        assert pressed(by_cells[cells]).force[2] == pytest.approx(expected, rel=allowed)


def test_the_face_goes_as_far_as_the_plate(cubes):
    body = cubes[1][8]
    touch = pressed(body)
    free = body.compliance.free_surface
    top = body.mesh.nodes[free, 2] > EDGE - 1e-9
    gone = -body.deform(touch.nodes, touch.nodal_forces)[top, 2] / DEPTH
    assert gone.mean() == pytest.approx(1.0, abs=0.03)
    # All but the four tips, where one node is a wide part of what gives way.
    assert np.sort(gone)[-5] < 1.12
    assert gone.min() > 0.88


def test_away_from_rims_a_fingertip_feels_what_the_ring_tells():
    """A fingertip of 14 mm in the middle, 94.8 mN per 10 kPa at 1.4 mm by scikit-fem."""
    body = baked_body(*paper_cube(EDGE, 8), 0.3, 1.0, formulation="smoothed")
    pose = Pose.at([EDGE / 2, EDGE / 2, EDGE + 0.0126])
    assert press_tool(body, sphere(0.014), pose).force[2] == pytest.approx(9.48e-6, rel=0.03)
