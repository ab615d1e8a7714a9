"""Laws of materials against finite differences, closed forms and linear elasticity."""

import numpy as np
import pytest

from palpate.core.law.barrier import FLATTEST, barrier
from palpate.core.law.foam import Cells, Foam
from palpate.core.law.law import convex_part
from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.law.of_material import LAWS
from palpate.core.law.ogden import Ogden
from palpate.core.law.principal import Power
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.stiffness.assembly import lame_parameters

RATIO = 0.4
LAWS = {
    "neo-Hookean": NeoHookean(),
    "Blatz-Ko": Foam(RATIO),
    "foam": Foam(RATIO, (Power(0.7, 8.0), Power(0.3, -2.0))),
    "St. Venant-Kirchhoff": StVenantKirchhoff(),
    **{name: one.law for name, one in LAWS.items()},
}


def moduli(count):
    first, shear = lame_parameters(1.0, RATIO)
    # Soft and stiff places: a law must take each one's own.
    scale = 1.0 + np.arange(count) / count
    return first * scale, shear * scale


def gradients(size, count=40):
    """Displacement gradients (3, 3, count) up to a size, none of them inverted."""
    found = size * np.random.default_rng(2).uniform(-1, 1, (3, 3, 4 * count))
    upright = np.linalg.det(np.eye(3) + found.transpose(2, 0, 1)) > 2 * FLATTEST
    return found[:, :, upright][:, :, :count]


def turned(gradient, turn):
    return turn @ (np.eye(3) + gradient) - np.eye(3)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("size", [0.01, 0.5])
def test_the_stress_is_the_derivative_of_the_energy(law, size):
    h = gradients(size)
    own, step = moduli(h.shape[2]), 1e-6
    found = law.stressed(h, *own).stress
    for i, j in np.ndindex(3, 3):
        way = np.zeros((3, 3, 1))
        way[i, j] = step
        up, down = (law.stressed(h + sign * way, *own).density for sign in (1, -1))
        assert np.allclose((up - down) / (2 * step), found[i, j], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("size", [0.01, 0.5])
def test_the_tangent_is_the_derivative_of_the_stress_and_symmetric(law, size):
    h = gradients(size)
    own, step = moduli(h.shape[2]), 1e-6
    tangent = law.tangent(h, *own)
    assert np.allclose(tangent, tangent.transpose(0, 2, 1), rtol=0, atol=1e-13 * tangent.max())
    for i, j in np.ndindex(3, 3):
        way = np.zeros((3, 3, 1))
        way[i, j] = step
        up, down = (law.stressed(h + sign * way, *own).stress for sign in (1, -1))
        slope = ((up - down) / (2 * step)).reshape(9, -1).T
        assert np.allclose(slope, tangent[:, :, 3 * i + j], rtol=0, atol=1e-7 * tangent.max())


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_small_strains_are_those_of_linear_elasticity(law):
    """Stresses keep their digits, however small the strain is."""
    for size in (1e-3, 1e-5, 1e-7):
        h = gradients(size)
        first, shear = moduli(h.shape[2])
        strain = 0.5 * (h + h.swapaxes(0, 1))
        trace = np.einsum("iid->d", strain)
        stress = 2 * shear * strain + first * trace * np.eye(3)[:, :, None]
        found = law.stressed(h, first, shear)
        # A foam's are of its stretches, which one and a small strain are added to.
        lost = 3e-15 / size if isinstance(law, Foam | Cells | Ogden) else 0.0
        assert np.abs(found.stress - stress).max() < (30 * size + lost) * np.abs(stress).max()
        energy = 0.5 * np.einsum("ijd,ijd->d", stress, strain)
        assert np.abs(found.density - energy).max() < 30 * (size + 1e-15 / size**2) * energy.max()


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_turn_of_space_or_of_the_material_changes_no_energy(law):
    h = gradients(0.5)
    own = moduli(h.shape[2])
    turn = np.linalg.qr(np.random.default_rng(5).standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    density = law.stressed(h, *own).density
    before = h.transpose(2, 0, 1)
    for other in (turned(before, turn), turn @ before @ turn.T):
        found = law.stressed(np.ascontiguousarray(other.transpose(1, 2, 0)), *own).density
        assert np.allclose(found, density, rtol=1e-12, atol=1e-14)


def neo_hookean_stress(stretches, first, shear):
    """First stress along three principal axes, by hand: mu (l - 1/l) + lambda (J - 1) J / l."""
    along = np.array(stretches)
    volume = along.prod()
    return shear * (along - 1 / along) + first * (volume - 1) * volume / along


@pytest.mark.parametrize(
    "stretches",
    [(0.4, 1.5, 1.5), (2.5, 0.65, 0.65), (1.4, 1.4, 0.52), (0.8, 0.8, 0.8)],
    ids=["uniaxial press", "uniaxial pull", "equibiaxial", "from all sides"],
)
def test_neo_hookean_principal_stresses(stretches):
    first, shear = lame_parameters(1.0, RATIO)
    h = np.diag(np.array(stretches) - 1.0)[:, :, None]
    found = NeoHookean().stressed(h, np.array([first]), np.array([shear])).stress[:, :, 0]
    expected = np.diag(neo_hookean_stress(stretches, first, shear))
    assert np.allclose(found, expected, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("shear_strain", [0.3, 1.0, 3.0])
def test_neo_hookean_simple_shear_is_linear_in_the_shear(shear_strain):
    """Cauchy's tau = mu gamma, and sigma_11 - sigma_22 = mu gamma^2 (Rivlin)."""
    first, shear = lame_parameters(1.0, RATIO)
    h = np.zeros((3, 3, 1))
    h[0, 1] = shear_strain
    stress = NeoHookean().stressed(h, np.array([first]), np.array([shear])).stress[:, :, 0]
    cauchy = stress @ (np.eye(3) + h[:, :, 0]).T
    assert cauchy[0, 1] == pytest.approx(shear * shear_strain, rel=1e-12)
    assert cauchy[0, 0] - cauchy[1, 1] == pytest.approx(shear * shear_strain**2, rel=1e-12)


def test_neo_hookean_rubber_is_pulled_as_incompressible_rubber_is():
    """s = mu (l - 1/l^2), Treloar's formula, as Poisson's ratio comes to one half."""
    first, shear = lame_parameters(1.0, 0.49999)
    for stretch in (0.4, 0.7, 1.5, 3.0):
        side = stretch**-0.5
        # The width that leaves the sides without stress, to first order in 1/lambda.
        pressure = shear * (side - 1 / side) * side
        volume = 1.0 - pressure / first
        side = np.sqrt(volume / stretch)
        found = neo_hookean_stress((stretch, side, side), first, shear)[0]
        assert found == pytest.approx(shear * (stretch - stretch**-2), rel=1e-3)


def test_what_is_flat_or_inside_out_is_driven_back():
    first, shear = (np.array([value]) for value in lame_parameters(1.0, RATIO))
    heights = np.linspace(-1.0, 1.0, 401)
    energies = [
        NeoHookean().stressed(np.diag([0, 0, height - 1.0])[:, :, None], first, shear).density[0]
        for height in heights
    ]
    assert np.isfinite(energies).all()
    assert (np.diff(energies) < 0).all()


def test_the_barrier_is_smooth_convex_and_exact_near_one():
    x = np.concatenate([np.linspace(-1.0, 0.2, 4001), np.linspace(0.21, 3.0, 500)])
    found = barrier(x - 1.0)
    assert (found.curvature > 0).all()
    assert np.allclose(np.gradient(found.value, x)[1:-1], found.slope[1:-1], rtol=1e-2, atol=1e-2)
    inside = x > FLATTEST
    assert np.allclose(
        found.value[inside], x[inside] - 1 - np.log(x[inside]), rtol=1e-9, atol=1e-15
    )
    for small in (1e-2, 1e-5, 1e-9):
        terms = sum((-1) ** k * small**k / k for k in range(2, 12))
        assert barrier(np.array([small])).value[0] == pytest.approx(terms, rel=1e-14)


def test_the_convex_part_keeps_what_is_convex_and_drops_the_rest():
    own = moduli(40)
    # Evenly pulled, no direction lowers the energy; pressed, turns do.
    pulled = np.repeat(0.1 * np.eye(3)[:, :, None], 40, axis=2)
    easy = NeoHookean().tangent(pulled, *own)
    assert np.allclose(convex_part(easy), easy, rtol=0, atol=1e-13 * easy.max())
    hard = StVenantKirchhoff().tangent(gradients(0.6), *own)
    assert np.linalg.eigvalsh(hard).min() < -0.1
    found = convex_part(hard)
    values = np.linalg.eigvalsh(found)
    assert values.min() > -1e-12 * hard.max()
    assert np.allclose(values.max(axis=1), np.linalg.eigvalsh(hard).max(axis=1))
