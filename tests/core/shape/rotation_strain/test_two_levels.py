"""Large bodies corrected on a lattice: against Newton's answer, and as a function of the forces."""

import numpy as np
import pytest
from bodies.bare_body import bare_body, beam_mesh
from referees.jumps import jump_left

from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.lattice.lattice import lattice_of
from palpate.core.shape.rotation_strain.two_levels import TwoLevels
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium

LENGTH = 5.0


def beam_body(cells=8, **material):
    """A beam of 5 x 1 x 1 m, clamped at x = 0, its tetrahedra finer than the lattices below."""
    return bare_body(*beam_mesh(cells, LENGTH, 0), **material)


class Case:
    """A body, its solid and its correction on a lattice."""

    def __init__(self, body, lattice_nodes):
        self.body = body
        self.solid = FreeSolid.of(body)
        self.levels = TwoLevels.of(body, lattice_nodes)

    def loaded(self, chosen, direction, by):
        """Equal forces (n, 3) on chosen nodes of the free surface: linearly it moves so far."""
        forces = np.where(chosen[:, None], np.asarray(direction, dtype=float), 0.0)
        return forces * by / np.abs(self.linear(forces)).max()

    @property
    def positions(self):
        return self.solid.positions[self.solid.surface]

    def whole(self, forces):
        held = np.zeros((self.solid.node_count, 3))
        held[self.solid.surface] = forces
        return held

    def linear(self, forces):
        return self.solid.linear(self.whole(forces))[self.solid.surface]

    def truth(self, forces):
        return equilibrium(self.solid, self.whole(forces)).displacements[self.solid.surface]

    def corrected(self, forces, steps=1):
        places = np.flatnonzero(forces.any(axis=1))
        return self.levels.corrected(self.linear(forces), places, forces[places], steps)


def distance(a, b):
    return np.linalg.norm(a - b) / np.linalg.norm(b)


@pytest.fixture(scope="module")
def beam():
    return Case(beam_body(), 150)


@pytest.fixture(scope="module")
def end_load(beam):
    return beam.loaded(beam.positions[:, 0] == LENGTH, [0.0, 0.0, 1.0], 0.3 * LENGTH)


def test_bends_come_near_the_true_one(beam, end_load):
    truth = beam.truth(end_load)
    linear = distance(beam.linear(end_load), truth)
    assert linear > 0.1
    assert distance(beam.corrected(end_load, 1), truth) < 0.2 * linear
    assert distance(beam.corrected(end_load, 2), truth) < 0.1 * linear


@pytest.mark.parametrize(
    ("poisson_ratio", "formulation", "share"), [(0.3, "linear", 0.5), (0.49, "smoothed", 0.5)]
)
def test_presses_come_near_the_true_one(poisson_ratio, formulation, share):
    mesh, fixed = paper_cube(1.0, 6)
    cube = Case(bare_body(mesh, fixed, poisson_ratio, formulation), 120)
    middle = np.linalg.norm(cube.positions - [0.5, 0.5, 1.0], axis=1) < 0.4
    forces = cube.loaded(middle, [0.0, 0.0, -1.0], 0.05)
    truth = cube.truth(forces)
    linear = distance(cube.linear(forces), truth)
    assert linear > 0.03
    assert distance(cube.corrected(forces), truth) < share * linear


def test_a_beam_with_a_stiff_half_comes_near():
    mesh = beam_body(6).mesh
    is_outer = mesh.nodes[mesh.tets].mean(axis=1)[:, 0] > 0.5 * LENGTH
    case = Case(beam_body(6, young_scale=np.where(is_outer, 10.0, 1.0)), 100)
    forces = case.loaded(case.positions[:, 0] == LENGTH, [0.0, 0.0, 1.0], 0.25 * LENGTH)
    truth = case.truth(forces)
    linear = distance(case.linear(forces), truth)
    assert distance(case.corrected(forces), truth) < 0.3 * linear


@pytest.mark.parametrize("steps", [1, 2])
def test_small_forces_give_the_linear_displacement_to_second_order(beam, end_load, steps):
    errors = []
    for share in (1e-4, 2e-4):
        forces = share * end_load
        errors.append(np.linalg.norm(beam.corrected(forces, steps) - beam.linear(forces)))
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=0.05)
    assert errors[1] < 1e-3 * np.linalg.norm(beam.linear(2e-4 * end_load))


def test_no_force_leaves_the_body_at_rest(beam):
    assert not beam.corrected(np.zeros_like(beam.positions)).any()


def test_pinned_places_stay(beam, end_load):
    """What the lattice adds there, where it is held by springs."""
    mesh, fixed = beam.body.mesh, beam.body.fixed
    lattice = lattice_of(mesh, 150)
    found = beam.levels.relaxation.relaxed(beam.levels.surface.T @ end_load, 1)
    at_pins = lattice.interpolation(mesh.nodes[fixed], lattice.node_parts[fixed]) @ found
    assert np.abs(at_pins).max() < 0.005 * np.abs(found).max()


def test_forces_are_the_slope_of_the_energy_of_strains_and_springs(beam, rng):
    native = beam.levels.relaxation.native
    moved, way = 0.01 * rng.normal(size=(2, beam.levels.surface.shape[1], 3))
    ends = [native.energy_and_forces(moved + sign * 1e-6 * way)[0] for sign in (1, -1)]
    slope = (native.energy_and_forces(moved)[1] * way).sum()
    assert slope == pytest.approx((ends[0] - ends[1]) / 2e-6, rel=1e-6)


def test_it_depends_continuously_on_the_forces(beam, end_load):
    """From rest through loads that shorten steps, and from one load to another."""
    crush = beam.loaded(beam.positions[:, 0] == LENGTH, [-1.0, 0.0, 0.0], LENGTH / 2)
    ways = (
        lambda share: 3.0 * share * end_load,
        lambda share: 1.5 * share * crush,
        lambda share: np.cos(np.pi * share) * end_load + np.sin(np.pi * share) * crush,
    )
    for way in ways:

        def shape(share, way=way):
            return beam.corrected(way(share))

        assert jump_left(shape, np.linspace(0.0, 1.0, 31), looks=3) < 0.02


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)])
def test_absurd_forces_give_numbers(beam, direction):
    forces = beam.loaded(beam.positions[:, 0] == LENGTH, direction, 1e3 * LENGTH)
    with np.errstate(all="raise", under="ignore"):
        found = beam.corrected(forces)
    assert np.isfinite(found).all()


def test_a_body_that_its_pins_do_not_hold_is_refused():
    mesh, _ = paper_cube(1.0, 4)
    with pytest.raises(PalpateError, match="pin"):
        TwoLevels.of(bare_body(mesh, np.array([0, 1])), 50)
