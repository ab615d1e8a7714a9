"""Hand and mass against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from palpate.core.devices.plant import ZERO, Impedance, Plant, Transition, exponential

STEP = 1e-3


@given(st.lists(st.floats(-30.0, 30.0), min_size=9, max_size=9))
def test_exponential_is_scipys(entries):
    matrix = np.array(entries).reshape(3, 3)
    expected = expm(matrix)
    found = np.array(exponential(matrix.tolist()))
    assert np.abs(found - expected).max() <= 1e-10 * max(1.0, np.abs(expected).max())


def oscillation(mass, stiffness, damping, start, seconds):
    """Position of m x'' = -k x - c x' from rest at `start`."""
    decay = damping / (2 * mass)
    square = stiffness / mass - decay**2
    if square > 0:
        w = math.sqrt(square)
        wave = math.cos(w * seconds) + decay / w * math.sin(w * seconds)
    elif square < 0:
        w = math.sqrt(-square)
        wave = math.cosh(w * seconds) + decay / w * math.sinh(w * seconds)
    else:
        wave = 1 + decay * seconds
    return start * math.exp(-decay * seconds) * wave


@pytest.mark.parametrize("hand_damping", [0.0, 1.0, 20.0 * math.sqrt(0.5), 60.0])
def test_a_released_hand_swings_as_the_damped_oscillator(hand_damping):
    """Under-, critically and overdamped; friction of the device belongs to the damping."""
    hand = Impedance(mass=0.1, damping=0.0, hand_stiffness=500.0, hand_damping=hand_damping)
    plant = Plant(hand, STEP, (0.01, -0.02, 0.0))
    # The target jumps before the first step, so that its damper does not pull.
    plant.target = ZERO
    for tick in range(1, 301):
        plant.step(ZERO, ZERO)
        for axis, start in enumerate((0.01, -0.02, 0.0)):
            expected = oscillation(0.1, 500.0, hand_damping, start, tick * STEP)
            assert plant.position[axis] == pytest.approx(expected, abs=1e-12)


def test_a_braked_device_swings_with_the_added_damping():
    plant = Plant(Impedance(damping=0.5, hand_damping=10.0), STEP, (0.01, 0.0, 0.0), brake=20.0)
    plant.target = ZERO
    for _ in range(100):
        plant.step(ZERO, ZERO, braked=True)
    assert plant.position[0] == pytest.approx(oscillation(0.1, 500.0, 30.5, 0.01, 0.1), abs=1e-12)


def test_a_constant_force_moves_the_rest_by_force_over_stiffness():
    plant = Plant(Impedance(hand_stiffness=500.0), STEP, (0.0, 0.0, 0.03))
    for _ in range(5000):
        plant.step((1.0, -0.5, 2.0), (0.0, 0.0, 0.03))
    assert plant.position == pytest.approx((0.002, -0.001, 0.034), abs=1e-12)
    assert plant.hand_force == pytest.approx((-1.0, 0.5, -2.0), abs=1e-9)
    assert plant.velocity == pytest.approx(ZERO, abs=1e-12)


def test_without_hand_and_friction_a_mass_falls_freely():
    nobody = Impedance(mass=0.2, damping=0.0, hand_stiffness=0.0, hand_damping=0.0)
    plant = Plant(nobody, STEP, ZERO)
    for _ in range(1000):
        plant.step((0.0, 0.0, -0.2 * 9.81), ZERO)
    assert plant.position[2] == pytest.approx(-0.5 * 9.81, rel=1e-12)
    assert plant.velocity[2] == pytest.approx(-9.81, rel=1e-12)


@given(
    st.lists(st.tuples(*[st.floats(-3.0, 3.0)] * 3), min_size=1, max_size=60),
    st.floats(0.02, 1.0),
    st.floats(1.0, 5000.0),
)
def test_without_damping_energy_changes_by_the_work_of_the_felt_force(forces, mass, stiffness):
    hand = Impedance(mass, damping=0.0, hand_stiffness=stiffness, hand_damping=0.0)
    plant = Plant(hand, STEP, (0.01, 0.0, -0.02))
    plant.target = ZERO

    def energy():
        kinetic = 0.5 * mass * sum(v * v for v in plant.velocity)
        return kinetic + 0.5 * stiffness * sum(x * x for x in plant.position)

    before = energy()
    for force in forces:
        plant.step(force, ZERO)
    assert energy() - before == pytest.approx(plant.work, rel=1e-9, abs=1e-12 * stiffness)


@given(st.floats(0.02, 1.0), st.floats(0.0, 1e6), st.floats(0.0, 1e4))
def test_no_stiffness_or_damping_is_too_much_for_the_step(mass, stiffness, damping):
    plant = Plant(Impedance(mass, damping, stiffness, 0.0), STEP, (0.01, 0.0, 0.0))
    plant.target = ZERO
    for _ in range(200):
        plant.step(ZERO, ZERO)
        assert abs(plant.position[0]) <= 0.01 * (1 + 1e-9)


def test_two_steps_are_one_of_twice_the_length():
    once = Transition.over(2 * STEP, 0.1, 500.0, 10.0)
    half = Transition.over(STEP, 0.1, 500.0, 10.0)
    matrix = np.array([[half.xx, half.xv], [half.vx, half.vv]])
    assert np.allclose(matrix @ matrix, [[once.xx, once.xv], [once.vx, once.vv]], atol=1e-15)


def test_a_hand_that_moves_evenly_is_followed_without_its_damper_holding_back():
    """The damper acts between hand and device: at the same speed it does nothing."""
    plant = Plant(Impedance(damping=0.0, hand_damping=30.0), STEP, ZERO)
    for tick in range(1, 2001):
        plant.step(ZERO, (tick * STEP * 0.1, 0.0, 0.0))
    # The spring's target stands still within a step, which leaves a ripple in the velocity.
    assert plant.velocity[0] == pytest.approx(0.1, rel=1e-3)
    assert plant.position[0] == pytest.approx(plant.target[0], abs=1e-8)
