"""Several moving fingers by the numpy reference, their god objects those of the servo."""

from dataclasses import replace

import numpy as np
import pytest
from palpate_servo.harness import Proxy

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.contact.pressing_fingers import fingers_at, press_fingers
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.servo.session import native_body
from palpate.core.stiffness.pins import PinNodes

TOP, SIDE = 0.05, 0.05


@pytest.fixture(scope="module")
def cube():
    mesh, fixed = paper_cube()
    return bake(mesh, BakeSettings(0.49, 10_000.0, PinNodes(fixed)))[0]


def followed(body, path):
    """Fingers after every tick of ``path`` (ticks, m, 3)."""
    native = native_body(body)
    god_objects = [Proxy(native) for _ in path[0]]
    for one, probe in zip(god_objects, path[0], strict=True):
        one.restart(probe)
    fingers, ticks = fingers_at(body, path[0]), []
    for probes in path:
        fingers = press_fingers(body, god_objects, fingers, probes)
        ticks.append(fingers)
    return ticks


def forces_of(ticks):
    return np.array([[finger.force for finger in fingers] for fingers in ticks])


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
def test_contacts_come_and_go_without_a_jump(cube, name):
    """The largest change of force in a tick shrinks as the ticks become shorter."""
    largest = []
    for count in (100, 400):
        ticks = followed(cube, PATHS[name](np.linspace(0, 1, count)))
        forces = forces_of(ticks)
        largest.append(np.linalg.norm(np.diff(forces, axis=0), axis=2).max())
    touched = [[finger.touch is not None for finger in fingers] for fingers in ticks]
    assert {tuple(one) for one in touched} >= {(False, False), (True, True)}
    assert largest[1] < 0.4 * largest[0]
    assert largest[1] < 0.1 * np.linalg.norm(forces, axis=2).max()


def test_a_contact_that_slides_ends_without_a_jump(cube):
    """Drawn towards the other, a finger leans sideways on its cone until the surface leaves it."""
    largest = []
    for count in (100, 400):
        down, s = np.linspace(0, 1, 20), np.linspace(0, 1, count)
        moving = 0.0275 - 0.0015 * np.concatenate([0 * down, s])
        z = TOP + 0.001 - 0.005 * np.concatenate([down, 1 + 0 * s])
        still, y = np.full_like(z, 0.02), np.full_like(z, 0.024)
        path = np.stack([np.stack([still, y, z], 1), np.stack([moving, y, z], 1)], 1)
        ticks = followed(cube, path)
        assert ticks[20][1].touch is not None
        assert ticks[-1][1].touch is None
        largest.append(np.linalg.norm(np.diff(forces_of(ticks[20:]), axis=0), axis=2).max())
    assert largest[1] < 0.4 * largest[0]


def test_a_finger_is_met_where_the_other_has_moved_the_surface_to(cube):
    """Pushed from the left, the right side comes out, and touches before its place at rest."""
    s = np.linspace(0, 1, 60)
    left = np.stack([0.008 * s - 0.001, 0 * s + 0.025, 0 * s + 0.03], axis=1)
    ahead = np.broadcast_to([SIDE + 1e-4, 0.025, 0.03], left.shape)
    ticks = followed(cube, np.stack([left, ahead], axis=1))
    first = next(tick for tick, (_, right) in enumerate(ticks) if right.touch is not None)
    alone = forces_of(followed(cube, left[:, None]))[:, 0]
    both = forces_of(ticks)
    np.testing.assert_allclose(both[:first, 0], alone[:first], rtol=1e-12)
    assert first > 10
    moved = [fingers[1].by_others[0] for fingers in ticks]
    assert moved[first - 2] <= 1e-4 < moved[first - 1]
    assert np.linalg.norm(both[first, 1]) < 0.1 * np.linalg.norm(both[-1, 1])
    assert both[-1, 1, 0] < 0


def test_the_surface_goes_where_both_fingers_are(cube):
    ticks = followed(cube, pinching(np.linspace(0, 0.5, 100)))
    touches = [finger.touch for finger in ticks[-1]]
    nodes = np.concatenate([touch.triangle for touch in touches])
    moved = cube.deform(nodes, np.concatenate([touch.nodal_forces for touch in touches]))
    for touch, probe in zip(touches, pinching(np.array([0.5]))[0], strict=True):
        surface = touch.point + cube.contact_displacement(touch, moved)
        np.testing.assert_allclose(surface, probe, atol=1e-7)


def test_one_finger_is_answered_as_it_always_was(cube):
    path = pinching(np.linspace(0, 1, 50))[:, :1]
    native, ticks = native_body(cube), followed(cube, path)
    proxy = Proxy(native)
    proxy.restart(path[0, 0])
    for (finger,), (probe,) in zip(ticks, path, strict=True):
        touching, at, triangle, alpha = proxy.move(probe)
        assert touching == (finger.touch is not None)
        if touching:
            alone = cube.touch(triangle, alpha, probe - at)
            np.testing.assert_allclose(finger.touch.force, alone.force, rtol=1e-12)


def test_a_finger_that_is_lifted_leaves_nothing_behind(cube):
    """As when a fault silences it: the other goes on as if it were alone."""
    ticks = followed(cube, pinching(np.linspace(0, 0.5, 100)))
    left, right = ticks[-1]
    lifted = replace(right, touch=None)
    native = native_body(cube)
    path = pinching(np.linspace(0, 0.5, 100))
    proxies = [Proxy(native), Proxy(native)]
    for one, start in zip(proxies, path[0], strict=True):
        one.restart(start)
    proxies[0].follow_path(path[:, 0])
    probes = np.array([path[-1, 0], [2 * SIDE, 0.025, 0.03]])
    fingers = (left, lifted)
    for _ in range(2):
        fingers = press_fingers(cube, proxies, fingers, probes)
    alone = cube.touch_nearest([0, 0.025, 0.03], probes[0] - [0, 0.025, 0.03])
    np.testing.assert_allclose(fingers[0].touch.force, alone.force, rtol=1e-6)
