"""Forces of the servo's own ticks: they do not jump, and closed paths do no work."""

from itertools import pairwise

import numpy as np
import pytest
from palpate_servo.harness import Proxy, SteppedFingers

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes

YOUNG_MODULUS = 10_000.0
TOP = 0.05
UP = np.array([0.0, 0.0, 1.0])
STICKING = {"static_friction": 9.0, "dynamic_friction": 9.0}


@pytest.fixture(scope="module")
def cube():
    mesh, fixed = paper_cube()
    return bake(mesh, BakeSettings(0.49, YOUNG_MODULUS, PinNodes(fixed)))[0]


@pytest.fixture(scope="module")
def native(cube):
    return native_body(cube, whole=True)


@pytest.fixture(scope="module")
def fingertip(cube, native):
    return native_tool(cube, native, sphere(0.012))


def fingers_at(native, start, rate_hz=1000, **feel):
    return SteppedFingers(native, start, Settings(YOUNG_MODULUS, **feel), rate_hz=rate_hz)


def along(corners, step):
    """A path (ticks, m, 3) over corners (k, m, 3)."""
    corners, pieces = np.array(corners), [np.array(corners[:1])]
    for start, end in pairwise(corners):
        count = int(np.ceil(np.linalg.norm(end - start, axis=1).max() / step))
        pieces.append(start + np.linspace(0, 1, count + 1)[1:, None, None] * (end - start))
    return np.concatenate(pieces)


def put(x, y, depth):
    return np.array([x, y, TOP - depth])


# A node of the mesh lies at (0.025, 0.025); edges run along both diagonals.
OVER_A_NODE = [
    [put(0.017, 0.018, -0.001)],
    [put(0.017, 0.018, 0.003)],
    [put(0.033, 0.032, 0.003)],
    [put(0.033, 0.032, -0.001)],
]
COMES_AND_GOES = [
    [put(0.02, 0.024, a), put(0.026, 0.021, b)]
    for a, b in ((-1e-3, -1e-3), (3e-3, -1e-3), (3e-3, 4e-3), (3e-3, -1e-3), (-1e-3, -1e-3))
]


@pytest.mark.parametrize(
    ("path", "feel"),
    [
        (OVER_A_NODE, {"mode": "paper"}),
        (OVER_A_NODE, {"mode": "consistent"}),
        (OVER_A_NODE, {"static_friction": 0.4, "dynamic_friction": 0.4}),
        (COMES_AND_GOES, {}),
    ],
    ids=["paper", "consistent", "friction", "two fingers"],
)
def test_smaller_steps_change_the_force_less(native, path, feel):
    largest = []
    for rate in (1000, 4000):
        walked = along(path, 0.1 / rate)
        forces, _ = fingers_at(native, walked[0], rate_hz=rate, **feel).follow(walked)
        assert (forces[0] == 0).all()
        assert (forces[-1] == 0).all()
        largest.append(np.linalg.norm(np.diff(forces, axis=0), axis=2).max())
    assert np.linalg.norm(forces, axis=2).max() > 0.3
    assert largest[1] < 0.4 * largest[0]


def test_letting_go_of_what_sticks_is_a_jump(native):
    """What the test above would say of one: static friction beyond the dynamic one."""
    largest = []
    for rate in (1000, 4000):
        path = along(OVER_A_NODE, 0.1 / rate)
        feel = {"static_friction": 0.5, "dynamic_friction": 0.3}
        forces, _ = fingers_at(native, path[0], rate_hz=rate, **feel).follow(path)
        largest.append(np.linalg.norm(np.diff(forces, axis=0), axis=2).max())
    assert largest[1] > 0.8 * largest[0]


def test_a_fingertip_does_not_jump_through_changing_patches(native, fingertip):
    largest = []
    for rate in (1000, 4000):
        path = along(OVER_A_NODE, 0.1 / rate) + 0.012 * UP
        tool = fingers_at(native, path[0], rate_hz=rate)
        tool.set_tool(fingertip, np.eye(3))
        forces, _ = tool.follow(path)
        largest.append(np.linalg.norm(np.diff(forces, axis=0), axis=2).max())
    assert np.linalg.norm(forces, axis=2).max() > 0.1
    assert (forces[-1] == 0).all()
    assert largest[1] < 0.4 * largest[0]


def test_one_finger_feels_what_proxy_and_contact_say(native):
    path = along(OVER_A_NODE, 2e-4)
    forces, torques = fingers_at(native, path[0]).follow(path)
    proxy = Proxy(native)
    proxy.restart(path[0, 0])
    for force, (probe,) in zip(forces[:, 0], path, strict=True):
        touching, at, triangle, alpha = proxy.move(probe)
        expected = np.zeros(3)
        if touching:
            expected = native.contact(triangle, alpha, probe - at, YOUNG_MODULUS)[1]
        np.testing.assert_allclose(force, expected, rtol=1e-12, atol=1e-15)
    assert not torques.any()


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


def test_a_finger_that_sticks_does_no_work_going_round(native):
    path = put(0.021, 0.026, 0.004) + around(50)[:, None]
    fingers = fingers_at(native, path[0] + 0.006 * UP, **STICKING)
    assert abs(share_of_work(fingers, path)) < 1e-12


def test_two_fingers_do_no_work_going_in_and_out_in_turn(native):
    turns = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * 1e-3
    path = along(
        [[put(0.021, 0.026, 0.004 + a), put(0.045, 0.025, 0.003 + b)] for a, b in turns], 5e-5
    )
    assert abs(share_of_work(fingers_at(native, path[0] + 0.006 * UP), path)) < 1e-12


def test_a_fingertip_does_no_work_going_round(native, fingertip):
    path = put(0.021, 0.026, 0.004) + 0.012 * UP + 3 * around(400)[:, None]
    tool = fingers_at(native, path[0] + 0.006 * UP)
    tool.set_tool(fingertip, np.eye(3))
    assert abs(share_of_work(tool, path, settling=4)) < 2e-5


def test_the_coupling_of_two_fingers_is_symmetric_and_positive(native):
    places = np.stack([put(0.021, 0.026, 0.004), put(0.031, 0.022, 0.003)])

    def felt(moved):
        fingers = fingers_at(native, places + 0.006 * UP, **STICKING)
        fingers.follow(places + np.linspace(0.006, 0, 60)[:, None, None] * UP)
        return fingers.follow((places + moved)[None])[0][-1].ravel()

    moves = 1e-6 * np.eye(6).reshape(6, 2, 3)
    matrix = np.array([felt(-move) - felt(move) for move in moves]).T / 2e-6
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * np.abs(matrix).max())
    assert np.linalg.eigvalsh(matrix)[0] > 1.0
    # The other finger is felt: it is no block matrix.
    assert np.abs(matrix[:3, 3:]).max() > 1.0


def test_paths_and_tools_without_sense_are_refused(native, fingertip):
    fingers = fingers_at(native, [[0.1, 0.1, 0.1]])
    with pytest.raises(ValueError, match=r"\(2, 2, 3\), expected \(ticks, 1, 3\)"):
        fingers.follow(np.zeros((2, 2, 3)))
    with pytest.raises(ValueError, match="not finite"):
        fingers.follow(np.full((1, 1, 3), np.nan))
    with pytest.raises(ValueError, match="no finger 1"):
        fingers.set_tool(fingertip, np.eye(3), 1)
    with pytest.raises(ValueError, match="no rotation"):
        fingers.set_tool(fingertip, np.ones((3, 3)))
    with pytest.raises(ValueError, match="1 to 5 fingers"):
        fingers_at(native, np.zeros((0, 3)))
