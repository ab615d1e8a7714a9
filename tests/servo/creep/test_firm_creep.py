"""Bodies by their law that give way with time: as firm as where they are pressed tells."""

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers
from ways.round_trips import round_trip, work_against
from ways.told_firmness import told

from palpate.core.contact.tool.tools import sphere
from palpate.core.servo.session import drawn_loads, native_tool
from palpate.core.servo.settings import Settings

YOUNG_MODULUS = 10_000.0
SERIES = ((0.8, 0.02), (0.5, 0.3))
TOP, RADIUS, DEPTH = 0.05, 0.012, 3e-3
MIDDLE = np.array([0.021, 0.027, TOP])
# 1 + s / 2 + 4 s^2 / 5, and 1 - s / 3 with s the depth of a point over that; of tools about.
FIRMER, SOFTER = (0.5, 0.8), (-1 / 3, 0.0)
# In, at rest, out; firmness has faded in when the finger rests.
WAY = DEPTH * np.concatenate(
    [np.linspace(-0.02, 1.0, 400), np.ones(600), np.linspace(1.0, -0.02, 400)]
)


@pytest.fixture(scope="module", params=["point", "sphere"])
def tool(request, cube_body, whole):
    return None if request.param == "point" else native_tool(cube_body, whole, sphere(RADIUS))


def fingers_on(whole, path, tool, relaxation, firmness=None, unit=None, friction=0.0):
    settings = Settings(
        YOUNG_MODULUS,
        relaxation=relaxation,
        static_friction=friction,
        dynamic_friction=friction,
    )
    fingers = SteppedFingers(whole, path[:1], settings)
    if tool is not None:
        fingers.set_tool(tool, np.eye(3))
    if firmness is not None:
        fingers.set_firmness(*told(firmness, unit))
    return fingers


def down(tool, depths):
    up = 0.0 if tool is None else RADIUS
    return MIDDLE + np.outer(up - depths, [0.0, 0.0, 1.0])


def led(whole, tool, depths, relaxation=SERIES, firmness=None, unit=None):
    """Force upwards (ticks,), and the fingers."""
    path = down(tool, depths)
    fingers = fingers_on(whole, path, tool, relaxation, firmness, unit)
    return fingers.follow(path[:, None])[0][:, 0, 2], fingers


def unit_of(whole, tool):
    """Energy that the linear press holds, J/Pa."""
    return led(whole, tool, np.linspace(-0.1, 1.0, 40) * DEPTH, ())[1].snapshot().held


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER])
def test_the_force_is_that_of_a_linear_body_times_the_firmness_of_the_place(whole, tool, firmness):
    """In, as it relaxes, and out again, until the dent is left: quasi-linear viscoelasticity."""
    unit = unit_of(whole, tool)
    elastic, firm = (led(whole, tool, WAY, (), one, unit)[0] for one in (None, firmness))
    linear = led(whole, tool, WAY)[0]
    found, _ = led(whole, tool, WAY, SERIES, firmness, unit)
    pressed = (linear > 0.01 * linear.max()) & (np.arange(len(WAY)) > 400)
    assert pressed.sum() > 700
    expected = linear * (firm / np.where(elastic > 0.0, elastic, 1.0))
    # Firmness is that of the tick before, and a tool's points are let go one by one.
    assert np.abs(found - expected)[pressed].max() < 0.01 * expected.max()
    rests = slice(700, 1000)
    np.testing.assert_allclose(found[rests], expected[rests], rtol=1e-4)


def test_it_is_drawn_as_a_linear_one_and_told_how_far_it_is_pressed_in(whole, tool):
    unit = unit_of(whole, tool)
    for ticks in (600, 1000):
        _, linear = led(whole, tool, WAY[:ticks])
        _, firm = led(whole, tool, WAY[:ticks], SERIES, FIRMER, unit)
        shots = linear.snapshot(), firm.snapshot()
        assert shots[1].firmness > 2.0
        for shot in shots:
            assert shot.held == pytest.approx(unit, rel=1e-3)
        (nodes, forces), (firm_nodes, firm_forces) = (drawn_loads(shot)[0] for shot in shots)
        np.testing.assert_array_equal(nodes, firm_nodes)
        np.testing.assert_allclose(firm_forces, forces, atol=2e-3 * np.abs(forces).max())


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER])
def test_cycles_about_a_depth_cost_energy_and_none_is_given(whole, tool, firmness):
    unit, rng = unit_of(whole, tool), np.random.default_rng(5)
    for _ in range(4):
        ticks = rng.integers(20, 300, 3)
        once = np.concatenate(
            [
                np.linspace(0.3, 1.1, ticks[0]),
                np.full(ticks[1], 1.1),
                np.linspace(1.1, 0.3, ticks[2]),
            ]
        )
        come = np.concatenate([np.linspace(-0.02, 0.3, 100), np.full(400, 0.3)])
        depths = DEPTH * np.concatenate([come, *[once] * 4])
        force, _ = led(whole, tool, depths, SERIES, firmness, unit)
        path = down(tool, depths)[:, 2]
        work = -np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(path))
        ends = work[np.arange(1, 5) * len(once) + len(come) - 2]
        assert (np.diff(ends) > 0.02 * np.ptp(work)).all()


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER])
def test_round_trips_cost_energy(whole, tool, firmness):
    up, unit = 0.0 if tool is None else RADIUS, unit_of(whole, tool)
    rng = np.random.default_rng(3)
    for _ in range(3):
        path = round_trip(rng, MIDDLE, up)
        fingers = fingers_on(whole, path, tool, SERIES, firmness, unit, friction=9.0)
        forces = fingers.follow(path[:, None])[0][:, 0]
        work = work_against(forces, path)
        assert work[-1] > -0.01 * work.max()
