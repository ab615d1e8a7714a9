"""The default coupling: passive for the documented range, and hardly felt on what is soft."""

import itertools
import math

import numpy as np
import palpate_servo
import pytest
from palpate_servo import harness
from passivity.closed_forms import stable_stiffness
from passivity.contact_loop import NONE, CouplingSettings, DevicePlant, PassiveHand, Press, press
from passivity.plant_range import COARSE, RANGE
from passivity.trials import is_passive, judge, stiffest_passive_body

from palpate.core.servo.haply_models import haply_model

DEFAULT = CouplingSettings.for_devices(1000)
CORNERS = list(RANGE.corners())
HARD = 5000.0


def test_the_range_is_what_the_document_says():
    assert CouplingSettings(800.0, 4.0, True) == DEFAULT
    assert len(CORNERS) == 128
    assert {plant.mass for plant in CORNERS} == {0.05, 0.5}
    assert all(plant.coulomb >= 1500.0 * plant.encoder_step for plant in CORNERS)
    drawn = list(RANGE.drawn(200, seed=3))
    assert drawn == list(RANGE.drawn(200, seed=3)) != list(RANGE.drawn(200, seed=4))
    assert all(plant.delay + plant.jitter <= 2e-3 for plant in drawn)
    assert any(plant.jitter > 0.0 for plant in drawn)
    assert all(1000 <= plant.rate_hz <= 4000 for plant in drawn)


@pytest.mark.parametrize("plant", CORNERS[5::16], ids=range(8))
def test_corners_of_the_range_are_passive(plant):
    """A few; benchmarks/servo/passivity_map.py takes all of them."""
    assert judge(plant, HARD, CouplingSettings.for_devices(plant.rate_hz)).passive


@pytest.mark.parametrize("plant", list(RANGE.drawn(8, seed=11)), ids=range(8))
def test_plants_inside_the_range_are_passive(plant):
    coupling = CouplingSettings.for_devices(plant.rate_hz)
    assert is_passive(plant, 700.0, coupling)


COARSE_CORNERS = list(COARSE.corners())


@pytest.mark.parametrize(
    "plant", [*COARSE_CORNERS[3::26], *COARSE.drawn(4, seed=7)], ids=lambda p: f"{p.mass:.2f}"
)
def test_coarse_encoders_have_a_coupling_that_is_passive(plant):
    assert judge(
        plant, HARD, CouplingSettings.for_devices(plant.rate_hz, plant.encoder_step)
    ).passive


def test_coarse_encoders_make_the_coupling_for_fine_ones_give_energy():
    """The 2DIY's step, with much friction."""
    plant = DevicePlant(0.1, 0.3, 0.1, palpate_servo.haply_encoder_step("2diy-3.1"), 2e-3, 1e-3)
    assert not is_passive(plant, HARD, DEFAULT)
    assert is_passive(plant, HARD, CouplingSettings.for_devices(1000, plant.encoder_step))


def test_only_coarse_encoders_change_the_coupling():
    assert CouplingSettings.for_devices(1000, 60e-6) == DEFAULT
    assert CouplingSettings.for_devices(1000, 0.3e-3) == CouplingSettings(200.0, 1.0, False)
    # Coarse or not, a slow servo is felt no stiffer than with fine encoders.
    slow = CouplingSettings.for_devices(100)
    assert CouplingSettings.for_devices(100, 70e-6).stiffness == slow.stiffness
    for wrong in (-1e-6, math.nan, math.inf):
        with pytest.raises(ValueError, match="encoder_step"):
            palpate_servo.device_coupling(encoder_step=wrong)


@pytest.mark.parametrize("model", ["2diy-3.1", "2diy-3.0", "2diy-2", "kit"])
def test_a_2diy_s_step_is_that_of_its_simulated_arm(model):
    """Both arms by two counts at the workspace's edges and between; by the other arm's solution."""
    haply = haply_model(model)
    half = (0.045, 0.025) if model == "kit" else (0.06, 0.035)
    turns = [math.radians(720.0 / resolution) for resolution in haply.resolutions]
    farthest = 0.0
    for x, y, sign in itertools.product((-1.0, 0.0, 1.0), (-1.0, 0.0, 1.0), (-1.0, 1.0)):
        place = haply.handle((x * half[0], y * half[1], 0.0))
        first, second = haply.arm.angles(place)
        after = haply.arm.handle((first + turns[0], second + sign * turns[1]))
        farthest = max(farthest, abs(after - place))
    assert palpate_servo.haply_encoder_step(model) == pytest.approx(farthest, rel=0.02)


@pytest.mark.parametrize("seconds", [0.036, 0.038, 0.041])
def test_a_spring_seen_in_steps_makes_nothing_by_that_alone(seconds):
    """Crept into, where a force that is a tick late makes a little; a parabola's energy is off by
    more, either way.
    """
    plant = DevicePlant(mass=0.05, damping=2.0, encoder_step=0.3e-3, rate_hz=8000)
    how = Press(speed=0.5, seconds=seconds, max_slew=1e12)
    outcome = press(plant, PassiveHand(push=1.0), 160.0, NONE, how)
    assert 0.0 < outcome["made_late"] < 7e-7


LIGHT = DevicePlant(0.05, 0.2, 0.03, 1e-6, 1e-3, 2e-3, 0.0, 1000)
"""Hardest of all corners: light, little friction, late."""


def test_the_hardest_corner_hums_and_pushes_without_the_coupling():
    assert LIGHT in CORNERS
    bare = judge(LIGHT, HARD, NONE)
    assert bare.extracted > 1e-3
    assert bare.hum > 1e-3
    assert is_passive(LIGHT, HARD, DEFAULT)


def test_neither_the_limit_nor_the_control_alone_is_enough_there():
    limit = CouplingSettings(stiffness=DEFAULT.stiffness)
    control = CouplingSettings(passivity_control=True)
    assert not is_passive(LIGHT, HARD, limit)
    assert not is_passive(LIGHT, HARD, control)


def test_passivity_control_takes_back_what_a_late_force_makes():
    """The limit alone, with and without control, in the middle of the range."""
    plant = DevicePlant(0.1, 0.3, 0.05, 10e-6, 1e-3, 1e-3)
    hand = PassiveHand(push=1.0)
    made = [
        press(plant, hand, HARD, CouplingSettings(800.0, 0.0, control), Press(speed=0.2))
        for control in (False, True)
    ]
    assert made[0]["extracted"] > 1e-4
    assert made[1]["extracted"] < 0.2 * made[0]["extracted"]


def forces(depths, body_stiffness, coupling):
    return harness.coupled_forces(depths, coupling, rate_hz=1000, body_stiffness=body_stiffness)


@pytest.mark.parametrize("body_stiffness", [100.0, 300.0, 750.0])
def test_soft_bodies_are_felt_as_they_are(body_stiffness):
    """A press of 5 mm in half a second and its release, seen through an encoder of 1 um."""
    time = np.arange(1, 1000) * 1e-3
    depths = np.round(2.5e-3 * (1.0 - np.cos(2.0 * np.pi * time)) / 1e-6) * 1e-6
    own = forces(depths, body_stiffness, NONE)
    found = forces(depths, body_stiffness, DEFAULT)
    assert np.abs(own + body_stiffness * depths).max() < 1e-12
    # At most 16 mm/s times 5 ms of the body's stiffness.
    assert np.abs(found - own).max() < 0.02 * np.abs(own).max()
    resting = np.full(200, 3e-3)
    assert forces(resting, body_stiffness, DEFAULT)[-1] == -body_stiffness * 3e-3


def test_a_stiff_body_is_felt_as_stiff_as_the_limit():
    resting = np.full(200, 2e-3)
    assert forces(resting, 3000.0, DEFAULT)[-1] == pytest.approx(-DEFAULT.stiffness * 2e-3)
    assert forces(resting, 3000.0, NONE)[-1] == -6.0


@pytest.mark.parametrize("rate_hz", [100, 500, 1000, 4000, 8000])
def test_slower_servos_get_a_softer_limit(rate_hz):
    coupling = CouplingSettings.for_devices(rate_hz)
    assert coupling.passivity_control
    assert coupling.stiffness <= 800.0
    assert (coupling.stiffness < 800.0) == (rate_hz < 1000)
    assert coupling.damping / coupling.stiffness >= 0.005 - 1e-12


def test_the_border_is_found_between_what_is_passive_and_what_is_not():
    plant = DevicePlant(0.1, 0.5, 0.03, 1e-6, 1e-3, 1e-3)
    border = stiffest_passive_body(plant, NONE, steps=8, halvings=2)
    assert is_passive(plant, border, NONE)
    assert not is_passive(plant, border * 1.5, NONE)
    # Not far before where it would be without any Coulomb friction, nor beyond all bounds.
    assert 0.8 < border / stable_stiffness(0.5, 1e-3, 1e-3) < 5.0
