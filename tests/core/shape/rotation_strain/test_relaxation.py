"""Steps towards equilibrium: against Newton's answer, and as a function of the forces."""

import numpy as np
import pytest
from bodies.bare_body import bare_body, beam_mesh
from referees.jumps import jump_left
from scipy.spatial.transform import Rotation

from palpate.core.compliance.elimination.cholesky import CholeskyFactor
from palpate.core.errors import PalpateError
from palpate.core.law.foam import Foam
from palpate.core.law.of_material import LAWS
from palpate.core.law.ogden import Ogden
from palpate.core.law.principal import Power
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.rotation_strain.relaxation import Patterns, relaxation
from palpate.core.shape.rotation_strain.rotation_strain_shape import frame_plan
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium

LENGTH = 5.0


# By measured constants, by two that differ by far, and of volumes at a constant Poisson's ratio.
POWERS = {
    **{name: one.law for name, one in LAWS.items()},
    "Mooney": Ogden((Power(0.8, 2.0), Power(0.2, -2.0))),
    "Storakers": Foam(0.3, (Power(0.7, 8.0), Power(0.3, -2.0))),
}


def beam(poisson_ratio=0.3, formulation="linear", young_scale=None, law=None):
    """The paper's cube drawn out to a beam of 5 x 1 x 1 m, clamped at x = 0."""
    mesh, fixed = beam_mesh(4, LENGTH, 0)
    return FreeSolid.of(bare_body(mesh, fixed, poisson_ratio, formulation, young_scale), law)


def end_load(solid, share, direction=(0.0, 0.0, 1.0)):
    """Forces (f, 3) on the free end, under which the linear beam moves by a share of its length."""
    forces = np.where(solid.positions[:, :1] == LENGTH, direction, 0.0)
    return forces * share * LENGTH / np.abs(solid.linear(forces)).max()


def relaxed(solid, forces, steps):
    return relaxation(solid).relaxed(forces, steps)


def distance(a, b):
    return np.linalg.norm(a - b) / np.linalg.norm(b)


@pytest.mark.parametrize(
    ("poisson_ratio", "formulation"), [(0.3, "linear"), (0.49, "linear"), (0.45, "smoothed")]
)
def test_bends_come_nearer_to_the_true_one_with_every_step(poisson_ratio, formulation):
    solid = beam(poisson_ratio, formulation)
    forces = end_load(solid, 0.3)
    truth = equilibrium(solid, forces).displacements
    linear = distance(solid.linear(forces), truth)
    errors = [distance(relaxed(solid, forces, steps), truth) for steps in range(4)]
    assert linear > 0.1
    assert errors[0] < 0.5 * linear
    assert errors[1] < 0.2 * linear
    assert errors[2] < 0.04 * linear
    assert errors[3] < 0.01 * linear


def test_a_bent_beam_with_a_stiff_half_comes_near():
    mesh, _ = paper_cube(1.0, 4)
    is_outer = mesh.nodes[mesh.tets].mean(axis=1)[:, 0] > 0.5
    solid = beam(young_scale=np.where(is_outer, 10.0, 1.0))
    forces = end_load(solid, 0.25)
    truth = equilibrium(solid, forces).displacements
    linear = distance(solid.linear(forces), truth)
    assert distance(relaxed(solid, forces, 0), truth) < 0.5 * linear
    assert distance(relaxed(solid, forces, 2), truth) < 0.03


def test_many_steps_arrive_at_equilibrium():
    solid = beam()
    forces = end_load(solid, 0.3)
    found = relaxed(solid, forces, 14)
    assert distance(found, equilibrium(solid, forces).displacements) < 1e-8


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_small_forces_give_the_linear_displacement_to_second_order(steps):
    solid = beam()
    errors = []
    for share in (1e-4, 2e-4):
        forces = end_load(solid, share)
        errors.append(np.linalg.norm(relaxed(solid, forces, steps) - solid.linear(forces)))
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("steps", [1, 3])
def test_it_depends_continuously_on_the_forces(steps):
    """From rest through loads that shorten steps, up to where the beam stands upright."""
    solid = beam()
    relaxing = relaxation(solid)
    load, crush = end_load(solid, 1.0), end_load(solid, 1.0, (-1.0, 0.0, 0.0))
    around = np.cross([1.0, 0.0, 0.0], solid.positions - [0.0, 0.5, 0.5])
    twist = np.where(load.any(axis=1)[:, None], around, 0.0) * np.abs(load).max() * LENGTH
    for forces in (load, crush, twist):

        def shape(share, forces=forces):
            return relaxing.relaxed(share * forces, steps)

        assert jump_left(shape, np.linspace(0.0, 1.5, 61), looks=4) < 0.02


def test_no_force_leaves_the_body_at_rest():
    solid = beam()
    for steps in (0, 2):
        assert not relaxed(solid, np.zeros((solid.node_count, 3)), steps).any()


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)])
def test_absurd_forces_give_numbers(direction):
    solid = beam()
    for times in (1e3, 1e6):
        for steps in range(4):
            with np.errstate(all="raise", under="ignore"):
                found = relaxed(solid, end_load(solid, times, direction), steps)
            assert np.isfinite(found).all()
            assert times > 1e3 or np.abs(found).max() < 1e3 * times


@pytest.mark.parametrize(
    ("poisson_ratio", "formulation"),
    [(0.45, "linear"), (0.45, "smoothed"), (0.0, "smoothed"), (-0.3, "linear"), (-0.3, "smoothed")],
)
@pytest.mark.parametrize("size", [1e-9, 1e-3, 0.02])
def test_energy_and_forces_are_those_of_the_laws_in_numpy(poisson_ratio, formulation, size, rng):
    solid = beam(poisson_ratio, formulation)
    moved = size * rng.normal(size=(solid.node_count, 3))
    assert min(solid.solid.terms[0].volume_ratios(moved)) > 0.0
    energy, forces = relaxation(solid).native.energy_and_forces(moved)
    assert energy == pytest.approx(solid.energy(moved), rel=1e-11 if poisson_ratio >= 0 else 1e-6)
    expected = solid.forces(moved)
    # numpy's foam, by the stretches of an SVD, has lost what is below its rounding.
    lost = 1e-15 / size if poisson_ratio < 0.0 else 0.0
    np.testing.assert_allclose(forces, expected, atol=(1e-11 + lost) * np.abs(expected).max())


@pytest.mark.parametrize("law", POWERS.values(), ids=POWERS)
@pytest.mark.parametrize("formulation", ["linear", "smoothed"])
@pytest.mark.parametrize("size", [1e-6, 1e-3, 0.02, 0.1])
def test_materials_are_those_of_numpy(law, formulation, size, rng):
    """Up to strains of one, and domains that are inside out."""
    solid = beam(0.3, formulation, law=law)
    moved = size * rng.normal(size=(solid.node_count, 3))
    assert size < 0.1 or min(solid.solid.terms[0].volume_ratios(moved)) < 0.1
    energy, forces = relaxation(solid).native.energy_and_forces(moved)
    lost = 1e-15 / size
    assert energy == pytest.approx(solid.energy(moved), rel=1e-10 + 10 * lost / size)
    expected = solid.forces(moved)
    np.testing.assert_allclose(forces, expected, atol=(1e-10 + lost) * np.abs(expected).max())


@pytest.mark.parametrize("law", ["rubber", "foam", "fibres", "natural-rubber"])
def test_even_pressure_and_a_turn_are_no_harder_than_others(law):
    """Stretches that are alike have no axes of their own."""
    solid = beam(0.3, law=LAWS[law].law)
    turn = Rotation.from_rotvec([0.4, -1.0, 0.7]).as_matrix()
    for map_ in (
        0.7 * np.eye(3),
        1.2 * turn,
        turn @ np.diag([0.8, 0.8, 1.1]),
        np.diag([0.0, 1, 1]),
    ):
        moved = solid.positions @ (map_ - np.eye(3)).T
        energy, forces = relaxation(solid).native.energy_and_forces(moved)
        expected = solid.forces(moved)
        assert energy == pytest.approx(solid.energy(moved), rel=1e-10)
        np.testing.assert_allclose(forces, expected, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("poisson_ratio", "law"),
    [(0.3, None), (-0.3, None), *((0.3, one) for one in POWERS.values())],
    ids=["rubber", "auxetic", *POWERS],
)
def test_forces_are_the_slope_of_the_energy_where_domains_collapse(poisson_ratio, law, rng):
    solid = beam(poisson_ratio, law=law)
    native = relaxation(solid).native
    moved, way = 0.1 * rng.normal(size=(2, solid.node_count, 3))
    ratios = solid.solid.terms[0].volume_ratios(moved)
    assert min(ratios) < 0.0 < max(ratios)
    ends = [native.energy_and_forces(moved + sign * 1e-6 * way)[0] for sign in (1, -1)]
    slope = (native.energy_and_forces(moved)[1] * way).sum()
    assert slope == pytest.approx((ends[0] - ends[1]) / 2e-6, rel=1e-6)


def patterns_of(solid, *forces):
    return Patterns(np.stack(forces), np.stack([solid.linear(one) for one in forces]))


@pytest.mark.parametrize(
    ("poisson_ratio", "formulation"), [(0.3, "linear"), (0.45, "smoothed"), (-0.3, "linear")]
)
@pytest.mark.parametrize("share", [0.05, 0.3, 1.0])
def test_rest_is_newtons_equilibrium_where_that_leads(poisson_ratio, formulation, share):
    solid = beam(poisson_ratio, formulation)
    up, along = end_load(solid, share), end_load(solid, share, (1.0, 0.2, 0.0))
    truth = equilibrium(solid, up + 0.5 * along).displacements
    patterns = patterns_of(solid, up, along)
    ways = np.einsum("pfi,fi->p", patterns.forces, truth)
    rest = relaxation(solid).led(patterns, ways, 1e-7, 300)
    assert rest.left <= 1e-7
    assert distance(rest.displacements, truth) < 1e-6
    np.testing.assert_allclose(rest.forces, [1.0, 0.5], rtol=1e-5)


def crushing(solid):
    """A press on one node of a beam, which gives way under it."""
    middle = np.linalg.norm(solid.positions - [LENGTH / 4, 0.5, 1.0], axis=1).argmin()
    forces = np.zeros((solid.node_count, 3))
    forces[middle] = [0.0, 0.0, -1.0]
    patterns = patterns_of(solid, forces / np.abs(solid.linear(forces)).max())
    return patterns, patterns.compliance[0]


def test_rest_is_found_where_a_press_crushes_what_it_presses():
    solid = beam(0.45, "smoothed")
    patterns, way = crushing(solid)
    rest = relaxation(solid).led(patterns, way, 1e-6, 400)
    assert rest.left <= 1e-6
    forces = rest.forces[0] * patterns.forces[0]
    unbalanced = np.abs(solid.forces(rest.displacements) - forces).max()
    assert unbalanced < 1e-4 * np.abs(forces).max()


def test_it_goes_on_from_the_last_rest_in_fewer_steps():
    solid = beam(0.45, "smoothed")
    patterns, way = crushing(solid)
    relaxing = relaxation(solid)
    at_once = relaxing.led(patterns, 0.8 * way, 1e-4, 400)
    before = relaxing.led(patterns, 0.7 * way, 1e-4, 400)
    after = relaxing.led(patterns, 0.8 * way, 1e-4, 400, before)
    assert max(one.left for one in (at_once, before, after)) <= 1e-4
    assert distance(after.displacements, at_once.displacements) < 1e-3
    assert after.steps < at_once.steps


def test_a_search_that_is_cut_short_says_what_is_left():
    solid = beam()
    patterns = patterns_of(solid, end_load(solid, 1.0))
    way = patterns.compliance[0]
    some, more = (relaxation(solid).led(patterns, way, 1e-9, steps) for steps in (1, 4))
    assert (some.steps, more.steps) == (1, 4)
    assert some.left > more.left > 1e-9


def test_two_threads_relax_one_body_each_in_its_own_room():
    solid = beam()
    one = relaxation(solid)
    other = one.another()
    forces = end_load(solid, 0.3)
    expected = one.relaxed(forces, 2)
    other.relaxed(2.0 * forces, 3)
    np.testing.assert_array_equal(one.relaxed(forces, 2), expected)
    np.testing.assert_array_equal(other.relaxed(forces, 2), expected)


def test_laws_that_are_not_known_are_refused():
    mesh, fixed = beam_mesh(2, LENGTH, 0)
    with pytest.raises(PalpateError, match="Newton"):
        relaxation(FreeSolid.of(bare_body(mesh, fixed, 0.1, "linear"), StVenantKirchhoff()))


@pytest.mark.parametrize("powers", [[], [(1.0, 0.0)], [(np.nan, 2.0)], 4 * [(0.25, 3.0)]])
def test_powers_that_are_none_are_refused(powers, monkeypatch):
    monkeypatch.setattr(
        "palpate.core.shape.rotation_strain.relaxation._powers", lambda _: (powers, [], False)
    )
    with pytest.raises(ValueError, match="do not fit"):
        relaxation(beam())


def test_arrays_that_do_not_fit_are_refused():
    solid = beam()
    native = relaxation(solid).native
    with pytest.raises(ValueError, match="a row for each free node"):
        native.warped(np.zeros((solid.node_count + 1, 3)))


def test_a_press_on_one_node_does_not_turn_the_body_inside_out():
    solid = beam()
    edge = np.linalg.norm(solid.positions - [LENGTH / 4, 0.0, 1.0], axis=1).argmin()
    forces = np.zeros((solid.node_count, 3))
    forces[edge] = [0.0, 1.0, -1.0]
    forces *= 0.6 / np.abs(solid.linear(forces)).max()
    truth = equilibrium(solid, forces).displacements
    for steps in range(1, 4):
        found = relaxed(solid, forces, steps)
        assert min(solid.solid.terms[0].volume_ratios(found)) > 0.4
        assert np.abs(found).max() < 0.9
    assert distance(found, truth) < 0.1 * distance(solid.linear(forces), truth)


def test_small_bodies_get_more_steps_and_large_ones_a_lattice():
    plans = [frame_plan(count) for count in (100, 1000, 1700, 20_000)]
    assert [plan.steps for plan in plans[:2]] == [4, 3]
    assert [plan.lattice_nodes > 0 for plan in plans] == [False, False, False, True]
    assert all(plan.steps >= 1 for plan in plans)


def test_numbers_of_32_bits_are_taken(monkeypatch):
    """As numpy's are on Windows before its version 2, in Blender 4.5 and 5.0."""
    solid = beam()
    wanted = relaxed(solid, end_load(solid, 0.3), 3)
    flat = CholeskyFactor.flat

    def short(*arguments, **names):
        parts = flat(*arguments, **names)
        return tuple(part.astype(np.int32) if part.dtype.kind == "i" else part for part in parts)

    monkeypatch.setattr(CholeskyFactor, "flat", short)
    assert np.array_equal(relaxed(solid, end_load(solid, 0.3), 3), wanted)
