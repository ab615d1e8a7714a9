"""Hand and mass against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from palpate.core.errors import PalpateError
from palpate.simulated.hand.coulomb import Slider
from palpate.simulated.hand.plant import ZERO, Impedance, Plant, Transition, exponential

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


def test_a_free_mass_is_stopped_by_coulomb_friction_at_the_right_place_and_time():
    """It slows down evenly: v^2 = 2 f x / m."""
    free = Impedance(0.2, damping=0.0, hand_stiffness=0.0, hand_damping=0.0, coulomb=0.1)
    plant = Plant(free, STEP, ZERO)
    plant.velocity = (0.0305, 0.0, 0.0)
    while plant.velocity[0] > 0.0:
        before = plant.velocity[0]
        plant.step(ZERO, ZERO)
        assert plant.velocity[0] == pytest.approx(max(0.0, before - 0.5 * STEP), abs=1e-15)
    assert plant.position[0] == pytest.approx(0.0305**2 * 0.2 / (2 * 0.1), rel=1e-12)
    assert plant.energy.coulomb == pytest.approx(0.5 * 0.2 * 0.0305**2, rel=1e-12)


def test_viscous_and_coulomb_friction_together_stop_it_where_theory_says():
    """m v' = -b v - f: x = m v0 / b - m f / b^2 ln(1 + b v0 / f)."""
    m, b, f, v0 = 0.1, 2.0, 0.05, 0.2
    free = Impedance(m, damping=b, hand_stiffness=0.0, hand_damping=0.0, coulomb=f)
    plant = Plant(free, STEP, ZERO)
    plant.velocity = (0.0, -v0, 0.0)
    for _ in range(300):
        plant.step(ZERO, ZERO)
    expected = m * v0 / b - m * f / b**2 * math.log(1 + b * v0 / f)
    assert plant.velocity[1] == 0.0
    assert plant.position[1] == pytest.approx(-expected, rel=1e-10)


def test_a_spring_with_coulomb_friction_loses_the_same_at_every_swing_and_sticks():
    """Half a swing takes 2 f / k off the amplitude; within f / k of the middle it sticks."""
    k, f, start = 500.0, 0.3, 0.01
    hand = Impedance(0.1, damping=0.0, hand_stiffness=k, hand_damping=0.0, coulomb=f)
    plant = Plant(hand, STEP, (start, 0.0, 0.0))
    plant.target = ZERO
    turns, last = [], -1.0
    for _ in range(3000):
        before = plant.velocity[0]
        plant.step(ZERO, ZERO)
        if before * plant.velocity[0] < 0.0 or (before != 0.0 and plant.velocity[0] == 0.0):
            turns.append(plant.position[0])
        last = plant.position[0]
    swings = [start - n * 2 * f / k for n in range(1, len(turns) + 1)]
    assert len(turns) == 8
    assert np.abs(turns[:-1]) == pytest.approx(swings[:-1], abs=2e-5)  # seen at whole steps
    assert abs(last) == pytest.approx(swings[-1], abs=1e-12)
    assert abs(last) <= f / k
    assert plant.velocity == ZERO


@pytest.mark.parametrize("step", [STEP, 7 * STEP])
def test_it_sticks_until_the_force_exceeds_the_friction_and_then_slides(step):
    grip = Impedance(0.1, 0.5, hand_stiffness=0.0, hand_damping=0.0, coulomb=0.2)
    plant = Plant(grip, step, ZERO)
    for _ in range(50):
        plant.step((0.2, -0.19999, 0.0), ZERO)
    assert plant.position == ZERO
    for _ in range(5000):
        plant.step((0.25, 0.0, 0.0), ZERO)
    assert plant.velocity[0] == pytest.approx((0.25 - 0.2) / 0.5, rel=1e-9)


@settings(max_examples=30)
@given(
    st.lists(st.tuples(*[st.floats(-3.0, 3.0)] * 3), min_size=1, max_size=30),
    st.lists(st.tuples(*[st.floats(-0.01, 0.01)] * 3), min_size=30, max_size=30),
    st.floats(0.03, 0.5),
    st.floats(0.0, 1000.0),
    st.sampled_from([0.0, 0.05, 0.5]),
    st.booleans(),
)
def test_the_energy_books_balance(forces, targets, mass, stiffness, coulomb, braked):
    """Work of motor and hand is what moves and what friction took."""
    grip = Impedance(mass, 0.5, stiffness, 0.005 * stiffness, coulomb)
    plant = Plant(grip, STEP, ZERO, brake=5.0)
    for force, target in zip(forces, targets, strict=False):
        plant.step(force, target, braked)
    books = plant.energy
    turned_over = abs(books.motor) + abs(books.hand) + books.viscous + books.coulomb
    balance = books.motor + books.hand - plant.kinetic - books.viscous - books.coulomb
    assert abs(balance) <= 1e-7 * turned_over + 1e-15
    assert (books.coulomb > 0.0) <= (coulomb > 0.0)


def test_with_next_to_no_coulomb_friction_the_motion_is_that_without():
    """Series and matrix exponential are two ways to the same motion."""
    places = []
    for coulomb in (0.0, 1e-13):
        plant = Plant(Impedance(coulomb=coulomb), STEP, (0.01, -0.003, 0.0), brake=20.0)
        for tick in range(200):
            plant.step((0.5, 0.1 * (tick % 3), -1.0), (0.0, 1e-5 * tick, 0.02), tick % 2 == 0)
        places.append((*plant.position, *plant.velocity))
    assert places[0] == pytest.approx(places[1], abs=1e-10)


def test_a_mass_too_small_for_its_step_is_refused_with_coulomb_friction():
    hand = Impedance(mass=1e-9, hand_stiffness=1e4, coulomb=0.1)
    assert not Slider(1e-9, 1e4, 10.0, 0.1).can_step(STEP)
    with pytest.raises(PalpateError, match="mass is too small"):
        Plant(hand, STEP, ZERO)
