"""A body that nobody holds, in the servo: forces and places as of ``Resting``, in any frame."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.laid import DOWN, TIP
from palpate_servo.harness import SteppedFingers
from scipy.spatial.transform import Rotation

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.rest.grip import Grip
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Support
from palpate.core.servo.session import displacements_of
from palpate.core.servo.settings import Settings

DEPTH = 0.004
ON_TOP = {"tool": np.array([0.03, 0.027, 0.0605]), "point": np.array([0.03, 0.027, 0.0505])}


def tip_of(kind):
    return TIP if kind == "tool" else None


def press(start, ticks=200, rest=200):
    """Places of a finger that stays, goes down by ``DEPTH`` and stays, (ticks, 3), m."""
    low = start - [0.0, 0.0, DEPTH]
    down = np.linspace(start, low, ticks)
    return np.concatenate([np.repeat(start[None], rest, 0), down, np.repeat(low[None], rest, 0)])


def touched_place(body, shot):
    mesh = body.mesh
    corners = mesh.nodes[mesh.surface_nodes][mesh.surface_local_triangles[shot.triangle_index]]
    return shot.alpha @ corners


@pytest.mark.parametrize("kind", ["tool", "point"])
def test_force_at_rest_is_that_of_a_body_without_a_clock(laid, kind):
    start = ON_TOP[kind]
    servo = laid.servo(start, tip=tip_of(kind))
    forces, _ = servo.follow(press(start, rest=2500)[:, None])
    shot = servo.snapshot()
    finger = TIP if kind == "tool" else Grip(touched_place(laid.body, shot), friction=0.0)
    resting = Resting(
        laid.body, laid.corner(), [(finger, Pose.at(start))], settings=laid.settings()
    )
    resting.settle()
    resting.lead([Pose.at(start - [0.0, 0.0, DEPTH])])
    rest = resting.settle()
    force = rest.tools[0].force
    assert force[2] > 1.0
    assert np.linalg.norm(forces[-1, 0] - force) < 1e-6 * np.linalg.norm(force)
    position, rotation = shot.placement
    assert np.abs(position - rest.placement.position).max() < 1e-9
    assert np.abs(rotation - rest.placement.rotation).max() < 1e-7


# With friction where a point sticks depends on how it came to be there: on rounding, too.
@pytest.mark.parametrize(("friction", "apart"), [(0.0, 1e-4), (0.4, 0.02)])
def test_each_tick_with_a_tool_is_that_of_a_body_without_a_clock(laid, friction, apart):
    start = ON_TOP["tool"]
    path = press(start, rest=50)
    # There and back: no jump aside, of whose friction a tick leaves most to the next.
    path[60:200] += 0.002 * np.sin(np.linspace(0.0, np.pi, 140))[:, None] * [1.0, 0.5, 0.0]
    floors = laid.corner(friction)
    resting = Resting(laid.body, floors, [(TIP, Pose.at(start))], settings=laid.settings(friction))
    felt = []
    # The servo makes a tick before it is led.
    resting.tick(1e-3, hurried=True)
    for place in path:
        resting.lead([Pose.at(place)])
        resting.tick(1e-3, hurried=True)
        felt.append(resting.rest.tools[0].force)
    servo = laid.servo(start, tip=TIP, friction=friction)
    forces = servo.follow(path[:, None])[0][:, 0]
    assert np.abs(np.array(felt) - forces).max() < apart * np.abs(felt).max()


@pytest.mark.parametrize("kind", ["tool", "point"])
@pytest.mark.parametrize("max_force", [None, 3.0])
def test_a_turned_world_turns_all_that_is_felt(laid, kind, max_force):
    start = ON_TOP[kind]
    path = press(start)
    turn = Rotation.from_rotvec([1.0, -2.0, 0.7])
    felt, shots = [], []
    for world in (Rotation.identity(), turn):
        servo = laid.servo(start, tip=tip_of(kind), turn=world, max_force=max_force)
        felt.append(world.inv().apply(servo.sent(world.apply(path)[:, None])[:, 0]))
        shots.append(servo.snapshot())
    largest = np.abs(felt[0]).max()
    assert largest > 1.0
    assert np.abs(felt[0] - felt[1]).max() < 1e-6 * largest
    upright, turned = shots
    assert np.abs(turn.apply(upright.probe) - turned.probe).max() < 1e-12
    assert np.abs(turn.apply(upright.proxy) - turned.proxy).max() < 1e-8
    assert np.abs(turn.apply(upright.placement[0]) - turned.placement[0]).max() < 1e-8
    assert np.abs(upright.nodal_forces - turned.nodal_forces).max() < 1e-6 * largest


def test_the_surface_of_a_point_is_where_the_finger_is(laid):
    start = ON_TOP["point"]
    servo = laid.servo(start)
    servo.follow(press(start, rest=500)[:, None])
    shot = servo.snapshot()
    assert shot.touching
    # Along its push exactly; aside the surface slides, for it has no friction.
    assert np.abs(shot.surface_point - shot.probe)[2] < 2e-5


def test_what_bears_it_is_told_and_carries_its_weight(laid):
    start = ON_TOP["tool"]
    servo = laid.servo(start, tip=TIP)
    servo.follow(press(start, rest=2500)[:, None])
    shot = servo.snapshot()
    _, rotation = shot.placement
    borne = rotation @ shot.borne_forces.sum(axis=0)
    pressed = -shot.fingers[0].contact_force
    weight = laid.body.mass * np.array(laid.settings().gravity)
    np.testing.assert_allclose(borne + pressed + weight, 0.0, atol=1e-6 * np.linalg.norm(weight))
    # Under these forces and the finger's it looks as one without a clock.
    resting = Resting(laid.body, laid.corner(), [(TIP, Pose.at(start))], settings=laid.settings())
    resting.settle()
    resting.lead([Pose.at(start - [0.0, 0.0, DEPTH])])
    expected = resting.settle().displacements()
    seen = displacements_of(laid.body, shot)
    np.testing.assert_allclose(seen, expected, rtol=0, atol=1e-5 * np.abs(expected).max())


def test_a_tick_is_seen_from_the_body_in_its_own_axes(laid):
    turn = Rotation.from_rotvec([0.3, -0.2, 0.5])
    start = ON_TOP["tool"]
    servo = laid.servo(start, tip=TIP, turn=turn)
    servo.follow(turn.apply(press(start, rest=500))[:, None])
    shot = servo.snapshot()
    own = shot.seen_from_body()
    position, rotation = shot.placement
    np.testing.assert_allclose(rotation @ own.probe + position, shot.probe, atol=1e-12)
    np.testing.assert_allclose(rotation @ own.contact_force, shot.contact_force, atol=1e-12)
    np.testing.assert_allclose(
        own.fingers[0].points @ rotation.T + position, shot.fingers[0].points, atol=1e-12
    )
    np.testing.assert_array_equal(own.nodal_forces, shot.nodal_forces)
    assert own.tick == shot.tick


def test_a_body_at_rest_on_a_plate_goes_on_from_there(laid):
    """Its rest shape overlaps the plate by how far it sags, not felt when set down anew."""
    turn = Rotation.from_rotvec([np.pi, 0.0, 0.0]).as_matrix()
    under = Support(plate(0.2, 0.2), Pose.at([0.025, 0.025, 0.0], turn), friction=0.5)
    settings = replace(laid.settings(gravity=DOWN), friction=0.5)
    resting = Resting(laid.body, [under], placement=Pose.at([0.0, 0.0, 1e-4]), settings=settings)
    before = resting.settle().placement
    assert before.position[2] < -1e-6
    start = np.array([0.3, 0.0, 0.1])
    servo = SteppedFingers(
        resting.native_body,
        start[None],
        Settings(laid.body.young_modulus),
        prop=resting.laid(),
        max_force=None,
    )
    servo.follow(np.repeat(start[None], 300, 0)[:, None])
    shot = servo.snapshot()
    np.testing.assert_allclose(shot.placement[0], before.position, atol=5e-5)
    weight = laid.body.mass * 9.81
    assert shot.borne_forces.sum(axis=0)[2] == pytest.approx(weight, rel=1e-3)
