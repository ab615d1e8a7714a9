"""Forces of the servo's own ticks: they do not jump, and closed paths do no work."""

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers
from referees.jumps import along, largest_change

from palpate.core.contact.tool.tools import sphere
from palpate.core.servo.session import native_tool
from palpate.core.servo.settings import Settings

YOUNG_MODULUS = 10_000.0
TOP = 0.05
UP = np.array([0.0, 0.0, 1.0])
RADIUS = 0.012
STICKING = {"static_friction": 9.0, "dynamic_friction": 9.0}


@pytest.fixture(scope="module")
def fingertip(cube_body, whole):
    return native_tool(cube_body, whole, sphere(RADIUS))


def fingers_at(whole, start, tool=None, rate_hz=1000, **feel):
    fingers = SteppedFingers(whole, start, Settings(YOUNG_MODULUS, **feel), rate_hz=rate_hz)
    if tool is not None:
        fingers.set_tool(tool, np.eye(3))
    return fingers


def put(x, y, depth):
    return np.array([x, y, TOP - depth])


# A node of the mesh lies at (0.025, 0.025); edges run along both diagonals.
OVER_A_NODE = [
    [put(0.017, 0.018, -0.001)],
    [put(0.017, 0.018, 0.003)],
    [put(0.033, 0.032, 0.003)],
    [put(0.033, 0.032, -0.001)],
]


def largest_changes(whole, path, tool=None, **feel):
    """The largest change of force in a tick of 1 ms and in one of 0.25 ms; forces in the latter."""
    largest = []
    for rate in (1000, 4000):
        walked = along(np.array(path), rate)
        forces, _ = fingers_at(whole, walked[0], tool, rate, **feel).follow(walked)
        assert (forces[0] == 0).all()
        assert (forces[-1] == 0).all()
        largest.append(largest_change(forces))
    return largest, forces


@pytest.mark.parametrize(
    ("feel", "has_tip", "least"),
    [
        ({"mode": "paper"}, False, 0.3),
        ({"mode": "consistent"}, False, 0.3),
        ({"static_friction": 0.4, "dynamic_friction": 0.4}, False, 0.3),
        ({}, True, 0.1),
    ],
    ids=["paper", "consistent", "friction", "a fingertip's changing patches"],
)
def test_smaller_steps_change_the_force_less(whole, fingertip, feel, has_tip, least):
    path, tool = np.array(OVER_A_NODE), fingertip if has_tip else None
    largest, forces = largest_changes(whole, path + has_tip * RADIUS * UP, tool, **feel)
    assert np.linalg.norm(forces, axis=2).max() > least
    assert largest[1] < 0.4 * largest[0]


def test_letting_go_of_what_sticks_is_a_jump(whole):
    """What the test above would say of one: static friction beyond the dynamic one."""
    feel = {"static_friction": 0.5, "dynamic_friction": 0.3}
    largest, _ = largest_changes(whole, OVER_A_NODE, **feel)
    assert largest[1] > 0.8 * largest[0]


def test_a_tick_that_ends_before_its_equilibrium_is_found_asks_for_no_brake(cube_body, whole):
    """What its bound on the work leaves to the next one is no energy that the body gained."""
    radius, rate = 0.004, 4000
    tool = native_tool(cube_body, whole, sphere(radius))
    corners = np.array([[put(0.0226, 0.0268, depth)] for depth in (-0.016, -0.001)])
    deep = np.array([[put(0.0221, 0.0268, 0.002)]])
    path = along(np.concatenate([corners, deep, corners[::-1]]) + radius * UP, rate, speed=0.05)
    feel = {"static_friction": 0.4, "dynamic_friction": 0.4}
    forces, _ = fingers_at(whole, path[0], tool, rate, **feel).follow(path)
    assert largest_change(forces) < 0.02 * np.linalg.norm(forces, axis=2).max()


def share_of_work(fingers, path, settling=1):
    lift = np.linspace(0.006, 0, 60)[:, None, None] * UP
    fingers.follow(path[0] + lift)
    fingers.follow(np.repeat(path[:1], 40, axis=0))
    forces = fingers.follow(np.repeat(path, settling, axis=0))[0][settling - 1 :: settling]
    work = np.einsum("tmx,tmx->t", 0.5 * (forces[1:] + forces[:-1]), np.diff(path, axis=0))
    return work.sum() / (0.5 * np.abs(work).sum())


def around(count):
    t = np.linspace(0, 2 * np.pi, count + 1)
    return 1e-3 * np.column_stack([0.8 - 0.8 * np.cos(t), 0.8 * np.sin(t), np.sin(2 * t)])


def test_a_finger_that_sticks_does_no_work_going_round(whole):
    path = put(0.021, 0.026, 0.004) + around(50)[:, None]
    fingers = fingers_at(whole, path[0] + 0.006 * UP, **STICKING)
    assert abs(share_of_work(fingers, path)) < 1e-12


def test_two_fingers_do_no_work_going_in_and_out_in_turn(whole):
    turns = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * 1e-3
    path = along(
        np.array([[put(0.021, 0.026, 0.004 + a), put(0.045, 0.025, 0.003 + b)] for a, b in turns]),
        2000,
    )
    assert abs(share_of_work(fingers_at(whole, path[0] + 0.006 * UP), path)) < 1e-12


def test_a_fingertip_does_no_work_going_round(whole, fingertip):
    """Where it is given time to settle: the law is a tick late, and takes energy for that."""
    path = put(0.021, 0.026, 0.004) + RADIUS * UP + 3 * around(1600)[:, None]
    tool = fingers_at(whole, path[0] + 0.006 * UP, fingertip)
    assert abs(share_of_work(tool, path, settling=12)) < 1e-6


def test_the_coupling_of_two_fingers_is_symmetric_and_positive(whole):
    places = np.stack([put(0.021, 0.026, 0.004), put(0.031, 0.022, 0.003)])

    def felt(moved):
        fingers = fingers_at(whole, places + 0.006 * UP, **STICKING)
        fingers.follow(places + np.linspace(0.006, 0, 60)[:, None, None] * UP)
        return fingers.follow((places + moved)[None])[0][-1].ravel()

    moves = 1e-6 * np.eye(6).reshape(6, 2, 3)
    matrix = np.array([felt(-move) - felt(move) for move in moves]).T / 2e-6
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * np.abs(matrix).max())
    assert np.linalg.eigvalsh(matrix)[0] > 1.0
    # The other finger is felt: it is no block matrix.
    assert np.abs(matrix[:3, 3:]).max() > 1.0


def test_paths_and_tools_without_sense_are_refused(whole, fingertip):
    fingers = fingers_at(whole, [[0.1, 0.1, 0.1]])
    with pytest.raises(ValueError, match=r"\(2, 2, 3\), expected \(ticks, 1, 3\)"):
        fingers.follow(np.zeros((2, 2, 3)))
    with pytest.raises(ValueError, match="must be finite"):
        fingers.follow(np.full((1, 1, 3), np.nan))
    with pytest.raises(ValueError, match="no finger 1"):
        fingers.set_tool(fingertip, np.eye(3), 1)
    with pytest.raises(ValueError, match="no rotation"):
        fingers.set_tool(fingertip, np.ones((3, 3)))
    with pytest.raises(ValueError, match="1 to 5 fingers"):
        fingers_at(whole, np.zeros((0, 3)))
