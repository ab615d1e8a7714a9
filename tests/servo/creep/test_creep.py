"""Bodies that give way with time, in the servo's own ticks."""

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers
from referees.hereditary import creep, held_force, retreating_force
from ways.round_trips import round_trip, work_against

from palpate.core.contact.tool.tools import sphere
from palpate.core.servo.session import displacements_of, native_tool
from palpate.core.servo.settings import Settings

YOUNG_MODULUS = 10_000.0
SERIES = ((0.8, 0.02), (0.5, 0.3))
TOP, RADIUS = 0.05, 0.012
MIDDLE = np.array([0.021, 0.027, TOP])
DT = 1e-3


@pytest.fixture(scope="module")
def fingertip(cube_body, whole):
    return native_tool(cube_body, whole, sphere(RADIUS))


def led(whole, depths, tool=None, relaxation=SERIES, **feel):
    """Force upwards (ticks,) of a finger led down to these depths, and the fingers."""
    up = RADIUS if tool is not None else 0.0
    path = MIDDLE + np.outer(up - np.asarray(depths), [0.0, 0.0, 1.0])
    start = MIDDLE + np.array([0.0, 0.0, up + 0.001])
    settings = Settings(YOUNG_MODULUS, relaxation=relaxation, **feel)
    fingers = SteppedFingers(whole, start[None], settings)
    if tool is not None:
        fingers.set_tool(tool, np.eye(3))
    walked = np.concatenate([np.linspace(start, path[0], 20)[:, None], path[:, None]])
    forces, _ = fingers.follow(walked)
    return forces[20:, 0, 2], fingers


@pytest.mark.parametrize("tip", ["point", "sphere"])
def test_pressed_in_and_held_it_relaxes_by_the_hereditary_integral(whole, fingertip, tip):
    tool = fingertip if tip == "sphere" else None
    depths = 3e-3 * np.minimum(np.arange(1, 800) / 100, 1.0)
    elastic, _ = led(whole, depths, tool, ())
    found, _ = led(whole, depths, tool)
    expected = held_force(SERIES, elastic, DT)
    assert np.abs(found - expected).max() < 0.03 * expected.max()
    assert found[-1] < 0.7 * found.max()


def test_a_sphere_that_sinks_in_as_it_creeps_keeps_its_force(whole, fingertip):
    """Depths of Lee and Radok for a force that stays: the elastic one grows by the creep."""
    grid = np.linspace(1e-5, 3.5e-3, 400)
    elastic, _ = led(whole, grid, fingertip, ())
    growing = creep(SERIES, 700, DT)
    depths = np.interp(0.9 * elastic[-1] * growing, elastic, grid)
    assert depths[-1] > 1.5 * depths[0]
    found, _ = led(whole, depths, fingertip)
    # It comes down within 20 ms, not at once; of that little is left after three times as long.
    assert np.abs(found[60:] / (0.9 * elastic[-1]) - 1.0).max() < 0.03


@pytest.mark.parametrize(("down", "held", "up"), [(100, 100, 100), (200, 0, 50), (50, 300, 400)])
def test_drawn_back_it_lets_go_as_ting_says(whole, fingertip, down, held, up):
    ways = [np.arange(1, down + 1) / down, np.ones(held), 1.0 - np.arange(1, up + 1) / up]
    depths = 3e-3 * np.concatenate(ways)
    elastic, _ = led(whole, depths, fingertip, ())
    found, _ = led(whole, depths, fingertip)
    expected = retreating_force(SERIES, elastic, depths, DT)
    assert np.abs(found - expected).max() < 0.03 * expected.max()
    # Long before the finger is back where the surface was, and without the pull that the integral
    # of the way in alone would give.
    let_go = np.flatnonzero(found > 0.0)[-1]
    assert let_go < len(depths) - 0.2 * up
    assert abs(let_go - np.flatnonzero(expected > 0.0)[-1]) <= 0.05 * up
    assert held_force(SERIES, elastic, DT)[let_go:].min() < -0.1 * expected.max()


def test_a_dent_comes_back_slowly_and_is_drawn(whole, cube_body):
    depths = np.concatenate([np.full(600, 3e-3), np.full(400, -2e-3)])
    _, fingers = led(whole, depths[:600])
    deepest = np.abs(displacements_of(cube_body, fingers.snapshot(), YOUNG_MODULUS)).max()
    _, elastic = led(whole, depths[:600], relaxation=())
    same = np.abs(displacements_of(cube_body, elastic.snapshot(), YOUNG_MODULUS)).max()
    assert deepest == pytest.approx(same, rel=0.01)
    before = deepest
    for ticks in (610, 700, 900):
        _, fingers = led(whole, depths[:ticks])
        shot = fingers.snapshot()
        assert not shot.touching
        dent = np.abs(displacements_of(cube_body, shot, YOUNG_MODULUS)).max()
        assert 0.0 < dent < before
        before = dent
    assert before < 0.5 * deepest


def test_who_presses_again_meets_the_dent(whole):
    down = np.full(800, 4e-3)
    way = np.concatenate([down, np.full(100, -1e-3), np.linspace(-1e-3, 4e-3, 500)])
    forces, _ = led(whole, way)
    fresh, _ = led(whole, way[900:])
    first = np.argmax(forces[900:] > 0.0)
    assert first > np.argmax(fresh > 0.0) + 20
    assert (forces[900:] <= fresh + 1e-9).all()


@pytest.mark.parametrize("tip", ["point", "sphere"])
def test_round_trips_cost_energy(whole, fingertip, tip):
    tool = fingertip if tip == "sphere" else None
    up = RADIUS if tool is not None else 0.0
    rng = np.random.default_rng(3)
    for _ in range(4):
        path = round_trip(rng, MIDDLE, up)
        settings = Settings(
            YOUNG_MODULUS, relaxation=SERIES, static_friction=9.0, dynamic_friction=9.0
        )
        fingers = SteppedFingers(whole, path[:1], settings)
        if tool is not None:
            fingers.set_tool(tool, np.eye(3))
        forces = fingers.follow(path[:, None])[0][:, 0]
        work = work_against(forces, path)
        assert work[-1] > -0.01 * work.max()


def test_a_body_that_is_elastic_remembers_nothing(whole):
    _, fingers = led(whole, np.full(50, 3e-3), relaxation=())
    assert len(fingers.snapshot().remembered_nodes) == 0
