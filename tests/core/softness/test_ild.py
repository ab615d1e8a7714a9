"""The virtual indentation test of foam, and the slab that it presses."""

import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.law.foam import Foam
from palpate.core.law.of_material import LAWS
from palpate.core.law.principal import Power
from palpate.core.softness.ild import POISSON_RATIO, ild_of_force, ild_of_young
from palpate.core.softness.pressed_slab import PressedSlab
from palpate.core.softness.scales.materials import MATERIALS
from palpate.core.stiffness.assembly import lame_parameters

POUND = 4.448
# Of the law of foam at a Poisson's ratio of 0, as it was measured.
FOAM = Foam(0.0, LAWS["foam"].law.terms)


@pytest.mark.parametrize(
    ("law", "share"),
    [(FOAM, 0.6), (Foam(0.2), 0.3), (Foam(0.3, (Power(1.0, 5.0),)), 0.2)],
    ids=["foam", "Blatz-Ko", "stiffer"],
)
def test_a_disc_as_wide_as_the_slab_presses_it_along_one_axis(law, share):
    """By hand: sides l^-nu, nominal stress 2 mu / a (l^a - J^(-ab)) / l."""
    ratio, stretch = law.poisson_ratio, 1.0 - share
    shear, b = lame_parameters(1.0, ratio)[1], ratio / (1.0 - 2.0 * ratio)
    volume = stretch ** (1.0 - 2.0 * ratio)
    stress = sum(
        2.0
        * shear
        * term.share
        / term.exponent
        * (stretch**term.exponent - volume ** (-term.exponent * b))
        / stretch
        for term in law.terms
    )
    whole = PressedSlab(law, ratio, 0.1, 0.1, 0.1)
    assert whole.forces((share,))[0] == pytest.approx(-stress * np.pi * 0.01, rel=1e-6)


@pytest.mark.at_length
def test_pressed_a_little_it_is_a_linear_slab():
    """115 N at 25 mm with 10 kPa, by a program of its own (docs/softness.md)."""
    force = ild_of_young(1.0)
    assert 1e4 * force.at_25 / force.mean_modulus == pytest.approx(115.0, rel=0.04)


@pytest.mark.parametrize(
    ("key", "pounds"),
    [
        pytest.param("PU_FOAM_SOFT", 18, marks=pytest.mark.at_length),
        ("LATEX_FOAM", 28),
        ("FOAM", 22),
        ("MEMORY_FOAM", 12),
    ],
)
def test_presets_of_foam_carry_the_modulus_of_what_is_sold(key, pounds):
    found, preset = ild_of_force(pounds * POUND), MATERIALS[key]
    assert found.at_25 == pytest.approx(pounds * POUND, rel=1e-9)
    assert preset.young_modulus == pytest.approx(found.young_modulus, rel=0.03)
    assert (preset.law, preset.poisson_ratio) == ("foam", POISSON_RATIO)


def test_the_course_of_the_force_is_that_of_foam():
    """Sold foams have 1.5 to 2.8 times the force at 65 % of that at 25 %."""
    found = ild_of_young(12_645.0)
    assert found.at_25 < found.at_40 < found.at_65
    assert 1.5 < found.support_factor < 2.8
    # Yielding: firm at first by more than the mean.
    assert found.young_modulus > 2.0 * found.mean_modulus


@pytest.mark.parametrize("make", [ild_of_force, ild_of_young])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan")])
def test_what_is_no_force_or_modulus_is_refused(make, value):
    with pytest.raises(PalpateError, match="positive"):
        make(value)
