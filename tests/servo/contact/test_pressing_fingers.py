"""Several moving fingers, tick by tick: when each touches, and what it presses."""

import numpy as np
import pytest
from bodies.shared import nodal_forces_of
from palpate_servo.harness import Proxy, SteppedFingers
from referees.jumps import largest_change

from palpate.core.contact.place import compliance_between
from palpate.core.contact.single_press import touch_nearest
from palpate.core.servo.settings import Settings

TOP, SIDE = 0.05, 0.05
MODULUS = 10_000.0


def fingers_on(whole, places):
    return SteppedFingers(whole, places, Settings(MODULUS))


def forces_along(whole, path):
    """Forces (ticks, m, 3) on fingers led along ``path`` (ticks, m, 3)."""
    return fingers_on(whole, path[0]).follow(path)[0]


def beside(s, apart):
    """One goes down and stays; the other comes down beside it and leaves, two times."""
    first, second = np.clip(4 * s, 0, 1), np.sin(2 * np.pi * np.clip(s - 0.25, 0, 1)) ** 2
    x, y = np.full_like(s, 0.02), np.full_like(s, 0.024)
    return np.stack(
        [
            np.stack([x, y, TOP + 0.001 - 0.006 * first], axis=1),
            np.stack([x + apart, y - 0.003, TOP + 0.001 - 0.006 * second], axis=1),
        ],
        axis=1,
    )


def pinching(s):
    """Two fingers on opposite sides, together and apart."""
    depth, still = 0.006 * np.sin(np.pi * s) ** 2, np.zeros_like(s)
    left = np.stack([depth - 0.001, still + 0.025, still + 0.03], axis=1)
    right = np.stack([SIDE + 0.001 - 0.7 * depth, still + 0.025, still + 0.03], axis=1)
    return np.stack([left, right], axis=1)


def through(s):
    """Both go down; then one is drawn through the other at the same depth."""
    z = TOP + 0.001 - 0.005 * np.clip(5 * s, 0, 1)
    still = np.full_like(s, 0.024)
    moving = 0.028 - 0.01 * np.clip(1.5 * s - 0.4, 0, 1)
    return np.stack(
        [np.stack([still - 0.001, still, z], axis=1), np.stack([moving, still, z], axis=1)], axis=1
    )


PATHS = {
    "beside on the next triangle": lambda s: beside(s, 0.012),
    "beside on the same triangle": lambda s: beside(s, 0.004),
    "a pinch": pinching,
    "through each other": through,
}


@pytest.mark.parametrize("name", PATHS)
def test_contacts_come_and_go_without_a_jump(whole, name):
    """The largest change of force in a tick shrinks as the ticks become shorter."""
    largest = []
    for count in (100, 400):
        forces = forces_along(whole, PATHS[name](np.linspace(0, 1, count)))
        largest.append(largest_change(forces))
    pressing = {tuple(one) for one in forces.any(axis=2).tolist()}
    assert pressing >= {(False, False), (True, True)}
    assert largest[1] < 0.4 * largest[0]
    assert largest[1] < 0.1 * np.linalg.norm(forces, axis=2).max()


def test_a_contact_that_slides_ends_without_a_jump(whole):
    """Drawn towards the other, a finger leans sideways on its cone until the surface leaves it."""
    largest = []
    for count in (100, 400):
        down, s = np.linspace(0, 1, 20), np.linspace(0, 1, count)
        moving = 0.0275 - 0.0015 * np.concatenate([0 * down, s])
        z = TOP + 0.001 - 0.005 * np.concatenate([down, 1 + 0 * s])
        still, y = np.full_like(z, 0.02), np.full_like(z, 0.024)
        path = np.stack([np.stack([still, y, z], 1), np.stack([moving, y, z], 1)], 1)
        forces = forces_along(whole, path)
        assert forces[20, 1].any()
        assert not forces[-1, 1].any()
        largest.append(largest_change(forces[20:]))
    assert largest[1] < 0.4 * largest[0]


def test_a_finger_is_met_where_the_other_has_moved_the_surface_to(cube_body, whole):
    """Pushed from the left, the right side comes out, and touches before its place at rest."""
    s = np.linspace(0, 1, 60)
    left = np.stack([0.008 * s - 0.001, 0 * s + 0.025, 0 * s + 0.03], axis=1)
    ahead = np.broadcast_to([SIDE + 1e-4, 0.025, 0.03], left.shape)
    both = forces_along(whole, np.stack([left, ahead], axis=1))
    alone = forces_along(whole, left[:, None])[:, 0]
    first = int(both[:, 1].any(axis=1).argmax())
    np.testing.assert_allclose(both[:first, 0], alone[:first], rtol=1e-9)
    assert first > 10
    places = cube_body.closest_points.query(np.array([[0.0, 0.025, 0.03], [SIDE, 0.025, 0.03]]))
    coupling = compliance_between(cube_body, places.triangle, places.alpha)[1, 0] / MODULUS
    moved = [float((coupling @ -force)[0]) for force in alone]
    assert moved[first - 2] <= 1e-4 < moved[first - 1]
    assert np.linalg.norm(both[first, 1]) < 0.1 * np.linalg.norm(both[-1, 1])
    assert both[-1, 1, 0] > 0


def test_one_finger_is_answered_as_it_always_was(cube_body, whole):
    path = pinching(np.linspace(0, 1, 50))[:, :1]
    proxy = Proxy(whole)
    proxy.restart(path[0, 0])
    forces, torques = fingers_on(whole, path[0]).follow(path)
    assert not torques.any()
    for (force,), (probe,) in zip(forces, path, strict=True):
        touching, at, triangle, alpha = proxy.move(probe)
        assert touching == force.any()
        if touching:
            alone = nodal_forces_of(cube_body, triangle, alpha, probe - at)
            np.testing.assert_allclose(force, -alone.sum(axis=0), rtol=1e-9)


def test_a_finger_that_is_lifted_leaves_nothing_behind(cube_body, whole):
    """As when a fault silences it: the other goes on as if it were alone."""
    path = pinching(np.linspace(0, 0.5, 100))
    fingers = fingers_on(whole, path[0])
    fingers.follow(path)
    away = np.array([2 * SIDE, 0.025, 0.03])
    fingers.set_down(away, 1)
    forces = fingers.follow(np.tile([path[-1, 0], away], (3, 1, 1)))[0]
    alone = touch_nearest(cube_body, [0, 0.025, 0.03], path[-1, 0] - [0, 0.025, 0.03])
    np.testing.assert_allclose(forces[-1, 0], alone.force, rtol=1e-6)
