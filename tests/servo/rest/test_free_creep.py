"""A body that nobody holds and that gives way with time, pressed by tools in the servo."""

import numpy as np
import pytest
from bodies.laid import TIP
from referees.hereditary import held_force

from palpate.core.servo.session import displacements_of

SERIES = ((0.8, 0.02), (0.5, 0.3))
START, DEPTH = np.array([0.03, 0.027, 0.0605]), 0.004
# Ticks of a millisecond: until it lies, down, and all of it.
LAID, DOWN, HELD = 1500, 100, 800


def pressed(laid, friction, relaxation):
    """Force upwards (ticks,) of a tool led down and held, and the fingers."""
    servo = laid.servo(START, tip=TIP, friction=friction, relaxation=relaxation)
    servo.follow(np.repeat(START[None], LAID, 0)[:, None])
    depths = DEPTH * np.minimum(np.arange(1, HELD) / DOWN, 1.0)
    forces, _ = servo.follow((START - np.outer(depths, [0.0, 0.0, 1.0]))[:, None])
    return forces[:, 0, 2], servo


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_pressed_in_and_held_it_relaxes_by_the_hereditary_integral(laid, friction):
    elastic, _ = pressed(laid, friction, ())
    found, _ = pressed(laid, friction, SERIES)
    expected = held_force(SERIES, elastic, 1e-3)
    assert np.abs(found - expected).max() < 0.01 * expected.max()
    assert found[-1] < 0.7 * found.max()


def test_let_go_it_stays_where_it_lies_and_its_dent_comes_back(laid):
    _, servo = pressed(laid, 0.4, SERIES)
    low = START - [0.0, 0.0, DEPTH]
    servo.follow((low + np.outer(np.linspace(0.0, 0.02, 50), [0.0, 0.0, 1.0]))[:, None])
    above = np.repeat(low[None] + [0.0, 0.0, 0.02], 200, 0)[:, None]
    free = laid.body.mesh.nodes[laid.body.compliance.free_surface]
    touched = int(np.linalg.norm(free - START, axis=1).argmin())
    dents, places = [], []
    for _ in range(16):
        forces, _ = servo.follow(above)
        assert not forces.any()
        shot = servo.snapshot()
        dents.append(-float(displacements_of(laid.body, shot)[touched, 2]))
        places.append(shot.placement[0])
    assert (np.diff(dents) < 0.0).all()
    assert dents[0] - dents[-1] > 1e-4
    # What is left is how it sags under its own weight.
    assert dents[-2] - dents[-1] < 1e-6
    assert np.abs(np.diff(places, axis=0)[-1]).max() < 1e-5
