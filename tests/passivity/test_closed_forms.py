"""The simulation of the servo's coupling against borders that others have derived."""

import math

import numpy as np
import pytest
from palpate_servo import harness
from passivity.closed_forms import passive_stiffness, quantised_stiffness, stable_stiffness
from passivity.contact_loop import NONE, DevicePlant, PassiveHand, Press, press

from palpate.simulated.hand.plant import ZERO, Impedance, Plant

PERIOD = 1e-3
OPEN = {"max_force": 1e9, "max_slew": 1e12}


def border(holds, low, high):
    """The largest value that still holds, by bisection of the logarithm."""
    assert holds(low)
    assert not holds(high)
    while high / low > 1.002:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def swings_less_and_less(plant, stiffness):
    """Pushed evenly so deep that it never leaves, with a little speed."""
    push = 10.0
    how = Press(start=push / stiffness, speed=1e-5, seconds=2.0, **OPEN)
    outcome = press(plant, PassiveHand(push=push), stiffness, how=how)
    return outcome["swing_late"] < outcome["swing_before"]


@pytest.mark.parametrize("damping", [0.2, 1.0])
@pytest.mark.parametrize("delay", [0.0, 1e-3, 3e-3])
def test_a_held_and_delayed_spring_swings_up_where_gil_and_others_say(damping, delay):
    plant = DevicePlant(mass=0.1, damping=damping, delay=delay)
    expected = stable_stiffness(damping, PERIOD, delay)
    found = border(lambda k: swings_less_and_less(plant, k), expected / 2, expected * 2)
    assert found == pytest.approx(expected, rel=0.01)


def test_at_another_rate_too():
    plant = DevicePlant(mass=0.2, damping=0.5, delay=0.5e-3, rate_hz=4000)
    expected = stable_stiffness(0.5, 0.25e-3, 0.5e-3)
    found = border(lambda k: swings_less_and_less(plant, k), expected / 2, expected * 2)
    assert found == pytest.approx(expected, rel=0.01)


def energy_from_path(stiffness, damping, coulomb, encoder_step, reach):
    """What a hand gets that jumps to and fro over an encoder's edge, in step with the servo.

    For a held and quantised spring it is the most profitable path there is: out right after a deep
    reading, in right after a shallow one. Energy a cycle, J.
    """
    edge = 100.5 * encoder_step if encoder_step > 0.0 else 0.01
    # It ends where it begins, so that what the spring has stored does not count.
    path = edge + reach * np.array([1.0, *[-1.0, 1.0] * 50])
    seen = np.round(path / encoder_step) * encoder_step if encoder_step > 0.0 else path
    held = harness.coupled_forces(seen, NONE, rate_hz=1000, body_stiffness=stiffness)
    way = np.diff(path)
    work = held[:-1] @ way
    friction = damping * np.sum(way**2) / PERIOD + coulomb * np.sum(np.abs(way))
    return (work - friction) / 50


@pytest.mark.parametrize("damping", [0.1, 0.5])
def test_no_path_gains_energy_up_to_colgate_and_schenkels_border(damping):
    def holds(stiffness):
        return energy_from_path(stiffness, damping, 0.0, 0.0, 1e-3) <= 0.0

    expected = passive_stiffness(damping, PERIOD)
    assert border(holds, expected / 3, expected * 3) == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("encoder_step", [20e-6, 60e-6])
@pytest.mark.parametrize("coulomb", [0.01, 0.05])
def test_quantisation_needs_the_coulomb_friction_of_diolaiti_and_others(encoder_step, coulomb):
    reaches = np.array([1e-4, 0.01, 0.3, 0.49, 40.0]) * encoder_step

    def holds(stiffness):
        return all(energy_from_path(stiffness, 2.0, coulomb, encoder_step, r) <= 0 for r in reaches)

    expected = quantised_stiffness(2.0, coulomb, PERIOD, encoder_step)
    assert border(holds, expected / 3, expected * 3) == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("coulomb", [0.0, 0.08])
def test_its_plant_moves_as_the_simulated_devices(coulomb):
    """Two programs, one physics: the same forces lead to the same places."""
    plant = DevicePlant(mass=0.07, damping=0.3, coulomb=coulomb, encoder_step=20e-6)
    hand = PassiveHand(stiffness=300.0, damping=1.2, target=0.004)
    outcome = press(plant, hand, 2000.0, how=Press(seconds=0.3), trace=True)
    other = Plant(Impedance(0.07, 0.3, 300.0, 1.2, coulomb), PERIOD, (-1e-4, 0.0, 0.0))
    other.velocity, other.target = (0.1, 0.0, 0.0), (0.004, 0.0, 0.0)
    for _, position, held in outcome["trace"]:
        other.step((held, 0.0, 0.0), (0.004, 0.0, 0.0))
        assert other.position[0] == pytest.approx(position, abs=1e-12)
    assert other.position[1:] == ZERO[1:]
    assert other.energy.motor == pytest.approx(outcome["motor"], abs=1e-12)
    assert other.energy.coulomb == pytest.approx(outcome["coulomb"], abs=1e-12)
    assert other.energy.viscous == pytest.approx(outcome["viscous"], abs=1e-10)
    assert outcome["largest_force"] > 0.5


@pytest.mark.parametrize("jitter", [0.0, 1.5e-3])
def test_the_energy_books_balance(jitter):
    plant = DevicePlant(0.06, 0.2, 0.05, 60e-6, 5e-3, 1e-3, jitter, 1500)
    outcome = press(plant, PassiveHand(400.0, 1.6, 0.1, 0.003), 1e4, how=Press(speed=0.3))
    given = outcome["start"] + outcome["motor"] + outcome["hand"]
    kept = outcome["kinetic"] + outcome["viscous"] + outcome["coulomb"]
    assert given == pytest.approx(kept, rel=1e-9)
    assert outcome["coulomb"] > 1e-5


def test_jitter_is_the_same_for_the_same_seed_and_another_for_another():
    plant = DevicePlant(0.06, 0.2, 0.05, 20e-6, 1e-3, 0.5e-3, 1e-3)
    ends = [
        press(plant, PassiveHand(push=1.0), 3000.0, how=Press(seconds=0.2, seed=seed))["motor"]
        for seed in (1, 1, 2)
    ]
    assert ends[0] == ends[1] != ends[2]


@pytest.mark.parametrize(
    ("name", "value"),
    [("mass", 0.0), ("damping", -1.0), ("delay", math.nan), ("rate_hz", 1), ("encoder_step", -1.0)],
)
def test_plants_without_sense_are_refused(name, value):
    with pytest.raises(ValueError, match=r"must be|rate"):
        press(DevicePlant(**{"mass": 0.1, "damping": 0.5, name: value}), PassiveHand(), 300.0)
