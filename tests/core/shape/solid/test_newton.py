"""Newton's equilibria: balance, convergence, work against energy, and where a body gives way."""

import numpy as np
import pytest
from bodies.bare_body import bare_body, beam_mesh

from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.inversion import is_upright, unhindered_share
from palpate.core.shape.solid.newton import RESIDUAL_SHARE, NoEquilibrium, equilibrium


def free_cube(poisson_ratio=0.3, formulation="linear", turn=None, cells=3, law=None):
    mesh, fixed = paper_cube(cells=cells)
    if turn is not None:
        mesh = TetMesh.checked(mesh.nodes @ turn.T, mesh.tets)
    return FreeSolid.of(bare_body(mesh, fixed, poisson_ratio, formulation), law)


@pytest.fixture(scope="module")
def cube():
    return free_cube()


def sideways(body, newton_per_pascal=1e-5):
    """A shear of the top, which bends and turns the cube."""
    forces = np.zeros((body.node_count, 3))
    forces[body.positions[:, 2] > 0.05 - 1e-9, 0] = newton_per_pascal
    return forces


def pushed(body, newton_per_pascal):
    """A push on the middle of a side."""
    forces = np.zeros((body.node_count, 3))
    nearest = np.linalg.norm(body.positions - [0.05, 0.034, 0.034], axis=1).argmin()
    forces[nearest, 0] = -newton_per_pascal
    return forces


@pytest.mark.parametrize(
    ("poisson_ratio", "formulation"), [(0.3, "linear"), (0.49, "linear"), (0.45, "smoothed")]
)
def test_forces_balance_and_convergence_is_quadratic(poisson_ratio, formulation):
    body = free_cube(poisson_ratio, formulation)
    forces = sideways(body)
    found = equilibrium(body, forces)
    assert np.abs(body.forces(found.displacements) - forces).max() < 1e-10 * forces.max()
    assert found.residual == found.history[-1] < 1e-10
    linear = body.linear(forces)
    assert np.abs(found.displacements - linear).max() > 0.04 * np.abs(linear).max()
    # Each residual is about the square of the one before, until rounding: digits double.
    digits = [np.log(share) for share in found.history if share > 1e-11]
    assert digits[-1] < 1.6 * digits[-2] < np.log(1e-3)


def test_a_turned_body_deforms_alike(cube):
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c, -s], [0, s, c]]
    turned = free_cube(turn=turn)
    forces = sideways(cube)
    expected = equilibrium(cube, forces).displacements @ turn.T
    found = equilibrium(turned, forces @ turn.T).displacements
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def test_small_loads_give_the_linear_displacements(cube):
    forces = sideways(cube, 1e-11)
    linear = cube.linear(forces)
    found = equilibrium(cube, forces).displacements
    assert np.abs(found - linear).max() < 1e-5 * np.abs(linear).max()


def test_the_work_of_the_load_is_the_energy_stored(cube):
    forces = sideways(cube)
    half_step = 1 / 32
    shares = np.arange(0, 1 + half_step / 2, half_step)
    moved, energies = [], []
    u = np.zeros_like(forces)
    for share in shares:
        u = equilibrium(cube, share * forces, start=u).displacements
        moved.append(float((forces * u).sum()))
        energies.append(cube.energy(u))
    # Work = s x - integral of x over s (by parts, Simpson's rule), with x = f . u.
    x = np.array(moved)
    simpson = half_step / 3 * (x[0] + x[-1] + 4 * x[1:-1:2].sum() + 2 * x[2:-2:2].sum())
    assert energies[-1] == pytest.approx(x[-1] - simpson, rel=1e-6)


def test_small_load_steps_and_a_start_lead_to_the_same_shape(cube):
    forces = sideways(cube)
    found = equilibrium(cube, forces)
    stepwise = equilibrium(cube, forces, largest_step=0.1)
    assert found.load_steps < 10 <= stepwise.load_steps
    size = np.abs(found.displacements).max()
    assert np.abs(found.displacements - stepwise.displacements).max() < 1e-9 * size
    again = equilibrium(cube, forces, start=1.001 * found.displacements)
    assert again.iterations < found.iterations
    assert np.abs(found.displacements - again.displacements).max() < 1e-9 * size


def test_a_body_that_gives_way_tells_where():
    cube = free_cube(law=StVenantKirchhoff())
    with pytest.raises(NoEquilibrium, match=r"gives way at \d+\.\d% of the load") as told:
        equilibrium(cube, pushed(cube, 1e-3))
    held = told.value.held
    assert 0.05 < held < 0.9
    assert is_upright(cube.solid, told.value.displacements)
    # About what it names is carried indeed, and a hundredth more is not.
    carried = equilibrium(cube, pushed(cube, 0.99e-3 * held))
    assert carried.residual < 1e-10
    with pytest.raises(NoEquilibrium):
        equilibrium(cube, pushed(cube, 1e-3 * (held + 0.01)))


def test_rubber_bears_what_that_law_gives_way_under(cube):
    """The same push, ten times what St. Venant-Kirchhoff's law carries, on the middle of a side."""
    found = equilibrium(cube, pushed(cube, 1e-3))
    assert found.residual < 1e-8
    assert is_upright(cube.solid, found.displacements)
    assert np.abs(found.displacements).max() > 0.2 * 0.05


def test_an_inverted_start_is_not_used(cube):
    forces = sideways(cube)
    inverted = cube.positions * [-2.0, 0.0, 0.0]
    assert not is_upright(cube.solid, inverted)
    found = equilibrium(cube, forces, start=inverted).displacements
    assert np.array_equal(found, equilibrium(cube, forces).displacements)


def test_no_step_goes_through_an_inversion(cube):
    rest = np.zeros((cube.node_count, 3))
    flatten = cube.positions * [0.0, 0.0, -1.0]
    assert unhindered_share(cube.solid, rest, 2.0 * flatten) == pytest.approx(0.45)
    assert unhindered_share(cube.solid, rest, 0.5 * flatten) == 1.0
    # A half turn by straight paths squeezes everything to a line, and ends upright.
    half_turn = cube.positions @ np.diag([-2.0, -2.0, 0.0])
    assert cube.solid.terms[0].volume_ratios(half_turn).max() == pytest.approx(1.0)
    assert unhindered_share(cube.solid, rest, half_turn) < 0.5


def test_without_a_load_the_body_rests(cube):
    found = equilibrium(cube, np.zeros((cube.node_count, 3)))
    assert not found.displacements.any()
    assert found.iterations == 0


def beam(cells, length, poisson_ratio, law=None):
    """A beam of 1 m square, held at one end."""
    return FreeSolid.of(bare_body(*beam_mesh(cells, length, 2), poisson_ratio), law)


def at_the_end(body, axis, linear_displacement):
    """A load on the beam's end that would move it so far if it were linear."""
    forces = np.zeros((body.node_count, 3))
    forces[body.positions[:, 2] > body.positions[:, 2].max() - 1e-9, axis] = 1.0
    return forces * (linear_displacement / np.abs(body.linear(forces)).max())


def test_the_line_search_takes_a_far_pull_at_once():
    """Full steps of Newton's method miss this one; without the search it takes two load steps."""
    body = beam(3, 10.0, 0.3, StVenantKirchhoff())
    found = equilibrium(body, at_the_end(body, 2, 30.0))
    assert found.load_steps == 1
    assert found.residual < 1e-8
    assert found.displacements[:, 2].max() > 9.0


def test_rounding_in_a_slender_body_is_no_collapse():
    """Thirty times as long as thick, bent by 9 m: its stresses are far above its load."""
    body = beam(4, 30.0, 0.49)
    found = equilibrium(body, at_the_end(body, 0, 9.0))
    assert RESIDUAL_SHARE < found.residual < 1e-8
