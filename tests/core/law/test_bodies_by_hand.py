"""Bodies of smoothed tetrahedra beside closed forms of rubber: a twisted rod, a tube blown up, a
bonded disc.

Each is solved on two meshes; what the finer one still errs by is a third of how far they are apart,
as errors fall with the square of the edges.
"""

import numpy as np
import pytest
from referees.led_solid import settled

from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.solid.solid import solid
from palpate.core.stiffness.assembly import lame_parameters

RATIO = 0.49
FIRST, SHEAR = lame_parameters(1.0, RATIO)
# A rod's thrust is of second order in its twist, and falls by four times 1 - 2 nu.
OF_ROD = 0.498
SHEAR_OF_ROD = lame_parameters(1.0, OF_ROD)[1]


def extrapolated(measure, coarse):
    """What a measure of so many cells tends to, from ``coarse`` ones and twice as many."""
    return (4.0 * np.array(measure(2 * coarse)) - np.array(measure(coarse))) / 3.0


def disc(height, cells):
    """A disc of radius 1: a cube whose squares are drawn out to circles."""
    cube = paper_cube(1.0, cells)[0]
    x, y, z = (cube.nodes * [2.0, 2.0, height] - [1.0, 1.0, 0.0]).T
    # Concentric squares become concentric circles (Shirley and Chiu 1997).
    wide = np.abs(x) >= np.abs(y)
    reach = np.where(wide, x, y)
    share = np.divide(np.where(wide, y, x), reach, out=np.zeros_like(x), where=reach != 0.0)
    turn = 0.25 * np.pi * share
    along, aside = reach * np.cos(turn), reach * np.sin(turn)
    places = np.column_stack([np.where(wide, along, aside), np.where(wide, aside, along), z])
    return TetMesh.checked(places, cube.tets)


def second_moment(mesh, height):
    """Integral of r squared over the cross-section of a prism, by its tetrahedra."""
    corners = mesh.nodes[mesh.tets][:, :, :2]
    squares = (corners**2).sum(axis=(1, 2)) + (corners.sum(axis=1) ** 2).sum(axis=1)
    return (mesh.tet_volumes * squares).sum() / 20.0 / height


def freedoms_of(nodes):
    return np.flatnonzero(np.repeat(nodes, 3))


def couple_and_thrust(twist, cells, height=1.0):
    """Of a rod of radius 1 whose ends are turned and kept apart, over mu J."""
    mesh = disc(height, cells)
    body = solid(mesh, OF_ROD, NeoHookean(), "smoothed")
    angle = twist * mesh.nodes[:, 2]
    x, y = mesh.nodes[:, :2].T
    cosine, sine = np.cos(angle), np.sin(angle)
    u = np.zeros(mesh.nodes.shape)
    u[:, :2] = np.column_stack([x * cosine - y * sine - x, x * sine + y * cosine - y])
    top, bottom = (np.isclose(mesh.nodes[:, 2], z) for z in (height, 0.0))
    u = settled(body, u, freedoms_of(~(top | bottom)))
    forces, arms = body.forces(u)[top], (mesh.nodes + u)[top]
    couple = (arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0]).sum()
    return np.array([couple, -forces[:, 2].sum()]) / (SHEAR_OF_ROD * second_moment(mesh, height))


@pytest.mark.parametrize("twist", [0.1, 0.5])
def test_a_twisted_rod_turns_back_and_pushes_its_ends_apart(twist):
    """Rivlin 1948: couple mu psi J, thrust mu psi^2 J / 2, J the second polar moment."""
    couple, thrust = extrapolated(lambda cells: couple_and_thrust(twist, cells), 4)
    assert couple == pytest.approx(twist, rel=0.02)
    assert thrust == pytest.approx(0.5 * twist**2, rel=0.05)


def pressure_in_a_tube(stretch, cells, high=0.25):
    """Within a tube of radii 1 and 2 whose length is kept, its inner wall widened by a stretch."""
    cube = paper_cube(1.0, cells)[0]
    radius, turn = 1.0 + cube.nodes[:, 0], 0.5 * np.pi * cube.nodes[:, 1]
    places = np.column_stack(
        [radius * np.cos(turn), radius * np.sin(turn), high * cube.nodes[:, 2]]
    )
    body = solid(TetMesh.checked(places, cube.tets), RATIO, NeoHookean(), "smoothed")
    wall = np.isclose(radius, 1.0)
    # Where rubber goes that keeps its volume; there the wall is held.
    widened = np.sqrt(radius**2 + stretch**2 - 1.0) / radius
    u = np.zeros(places.shape)
    u[:, :2] = places[:, :2] * (widened - 1.0)[:, None]
    held = np.zeros(places.shape, dtype=bool)
    held[wall, :2] = True
    held[np.isclose(cube.nodes[:, 1], 1.0), 0] = True
    held[np.isclose(cube.nodes[:, 1], 0.0), 1] = True
    held[:, 2] = np.isclose(cube.nodes[:, 2], 0.0) | np.isclose(cube.nodes[:, 2], 1.0)
    u = settled(body, u, np.flatnonzero(~held.ravel()))
    outward = np.einsum("nx,nx->n", body.forces(u)[wall, :2], places[wall, :2])
    return outward.sum() / (0.5 * np.pi * stretch * high)


@pytest.mark.parametrize("stretch", [1.05, 1.4])
def test_a_tube_is_blown_up_by_the_pressure_of_rubber(stretch):
    """p = mu (ln(a/b) + (1/b^2 - 1/a^2) / 2), a and b the stretches of its walls."""
    pressure = extrapolated(lambda cells: pressure_in_a_tube(stretch, cells), 3)
    outer = np.sqrt(4.0 + stretch**2 - 1.0) / 2.0
    expected = SHEAR * (np.log(stretch / outer) + 0.5 * (outer**-2 - stretch**-2))
    assert pressure == pytest.approx(expected, rel=0.03)


def modulus_of_a_bonded_disc(cells, height=0.5, pressed=1e-4):
    mesh = disc(height, cells)
    body = solid(mesh, RATIO, NeoHookean(), "smoothed")
    low, high = (np.isclose(mesh.nodes[:, 2], z) for z in (0.0, height))
    u = np.zeros(mesh.nodes.shape)
    u[:, 2] = -pressed * mesh.nodes[:, 2] / height
    u = settled(body, u, freedoms_of(~(low | high)))
    area = mesh.tet_volumes.sum() / height
    return -body.forces(u)[high, 2].sum() / area * height / pressed


def test_a_bonded_disc_is_firmer_by_its_shape():
    """E (1.2 + 2 S^2), S the loaded over the free area, here 1, with the bulk modulus before it.

    Horton, Tupholme and Gover 2002, who put 1.2 for Gent's and Lindley's 1.
    """
    modulus = extrapolated(modulus_of_a_bonded_disc, 4)
    bulk = FIRST + 2.0 / 3.0 * SHEAR
    assert modulus == pytest.approx(1.0 / (1.0 / 3.2 + 1.0 / bulk), rel=0.03)
