"""Relaxation: every preset can be felt, and is what it says at the ends of time."""

import math

import pytest

from palpate.core.errors import PalpateError
from palpate.core.law.relaxation import RELAXATIONS, Relaxation, RelaxationTerm
from palpate.core.servo.session import native_body, servo_on
from palpate.core.servo.settings import Settings
from palpate.core.softness.scales.materials import MATERIALS


def test_every_material_has_a_series_that_there_is():
    for material in MATERIALS.values():
        assert material.relaxation in RELAXATIONS


@pytest.mark.parametrize("relaxation", RELAXATIONS.values(), ids=RELAXATIONS)
def test_a_series_is_one_that_the_servo_takes(relaxation, cube):
    servo_on(native_body(cube, whole=True), Settings(1e4, relaxation=relaxation.pairs))
    assert relaxation.source
    at_once = 1.0 + sum(share for share, _ in relaxation.pairs)
    assert relaxation.modulus(0.0) == pytest.approx(at_once)
    assert relaxation.modulus(1e4) == pytest.approx(1.0)


def test_the_loss_tangent_of_a_standard_linear_solid():
    solid = Relaxation("solid", (RelaxationTerm(3.0, 0.5),), "test")
    # Largest, (E0 - E) / (2 sqrt(E0 E)), where omega t = sqrt(E / E0).
    hertz = math.sqrt(1 / 4) / 0.5 / (2 * math.pi)
    assert solid.loss_tangent(hertz) == pytest.approx(3.0 / (2 * 2.0))
    assert solid.loss_tangent(1e-6) < 1e-4
    assert solid.loss_tangent(1e6) < 1e-4


@pytest.mark.parametrize("pairs", [((-1.0, 1.0),), ((1.0, 0.0),), ((1.0, 2.0), (3.0, 2.0))])
def test_what_is_no_series_is_refused_with_a_remedy(pairs, cube):
    with pytest.raises((PalpateError, ValueError), match=r"relaxation is .*give at most 3"):
        servo_on(native_body(cube, whole=True), Settings(1e4, relaxation=pairs))
