"""Tools tick by tick: they come to rest where the engine without a clock does, and only there."""

import numpy as np
import pytest
from bodies.inner_corner import inner_corner
from bodies.shared import highest_place
from bodies.soft_block import soft_block
from palpate_servo import Tool as NativeTool
from palpate_servo import ToolSurface
from palpate_servo.harness import SteppedFingers, ToolContact, tool_costs
from scipy.spatial.transform import Rotation

from palpate.core.contact.press import Press
from palpate.core.contact.tool.convex_tool import convex
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tool_surface import surface_and_correction
from palpate.core.contact.tool.tools import plate, rod, sphere
from palpate.core.errors import PalpateError
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.008
TOOLS = {
    "sphere": sphere(0.018),
    "rod": rod(0.014, 0.015),
    "plate": plate(0.016, 0.016),
    "hull": convex(BOX, 0.003),
}
UP = np.array([0.0, 0.0, 1.0])
# What a tick leaves to the next ones is found by then.
TICKS_TO_SETTLE = 200
# A place at a plate's edge may rest against either of its faces (docs/fingertip.md). So many poses
# of a path may come out so, and by this share of the force at most.
OTHER_RESTS, OTHER_REST = {"plate": 1}, 0.02


def path_over(body, tool):
    """Poses down onto the body, 3 mm deep, and along it, turning; less than a stride apart."""
    middle = highest_place(body)
    above = -float(tool.core[:, 2].min() - tool.radius)
    for tick in np.arange(0.0, 6.5, 0.5):
        along = np.array([0.004 * np.sin(tick / 3), 0.004 * np.cos(tick / 4) - 0.002, 0.0])
        turn = Rotation.from_rotvec([0.1 * np.sin(tick / 3), 0.08 * np.sin(tick / 2), 0.05 * tick])
        height = above + 0.001 - min(0.001 * tick, 0.004)
        yield Pose(middle + along + [0.0, 0.0, height], turn.as_matrix())


def settled(contact, pose, young_modulus):
    """Ticks at one pose until nothing changes any more."""
    for _ in range(TICKS_TO_SETTLE):
        contact.follow(pose.position, pose.rotation, young_modulus)


@pytest.mark.parametrize("name", list(TOOLS))
def test_ticks_come_to_rest_where_the_engine_does(body, surface, name):
    tool = TOOLS[name]
    contact, press = ToolContact(*native_tool(body, surface, tool)), Press(body, [tool])
    poses = list(path_over(body, tool))
    contact.restart(poses[0].position, poses[0].rotation)
    pressed = others = 0
    for pose in poses:
        settled(contact, pose, body.young_modulus)
        (touch,) = press.to([pose])
        assert contact.touching == touch.touching
        scale = max(float(np.linalg.norm(touch.force)), 1e-9)
        apart = np.linalg.norm(contact.force - touch.force)
        if apart > 1e-6 * scale and others < OTHER_RESTS.get(name, 0):
            assert apart < OTHER_REST * scale
            others += 1
            continue
        np.testing.assert_allclose(contact.force, touch.force, atol=1e-6 * scale)
        np.testing.assert_allclose(contact.torque, touch.torque, atol=1e-6 * scale * tool.reach)
        stiffness = np.abs(touch.stiffness).max(initial=1e-9)
        np.testing.assert_allclose(contact.stiffness, touch.stiffness, atol=1e-5 * stiffness)
        order = np.argsort(contact.points)
        np.testing.assert_array_equal(contact.points[order], touch.points)
        np.testing.assert_allclose(contact.forces[order], touch.forces, atol=2e-6 * scale)
        pressures = touch.largest_pressure or 1e-9
        np.testing.assert_allclose(contact.pressures[order], touch.pressures, atol=1e-5 * pressures)
        found = np.zeros((len(body.mesh.nodes), 3))
        found[body.mesh.surface_nodes[contact.nodes]] = contact.nodal_forces
        expected = np.zeros_like(found)
        expected[touch.nodes] = touch.nodal_forces
        np.testing.assert_allclose(found, expected, atol=2e-6 * scale)
        pressed = max(pressed, len(touch.points))
    assert pressed >= 3


def test_a_tool_goes_at_most_one_stride_a_tick_and_does_not_jump_through_the_body(body, surface):
    tool = TOOLS["sphere"]
    contact, top = ToolContact(*native_tool(body, surface, tool)), highest_place(body)
    contact.restart(top + 1.2 * tool.radius * UP, np.eye(3))
    for _ in range(4):
        before = contact.position
        contact.follow(top - [0.0, 0.0, 0.1], np.eye(3), body.young_modulus)
        assert np.linalg.norm(contact.position - before) <= 0.25 * tool.inner_radius * 1.0001
    assert contact.force[2] > 0
    before, turn = contact.rotation, Rotation.from_rotvec([3.0, 0.0, 0.0]).as_matrix()
    contact.follow(contact.position, turn, body.young_modulus)
    angle = Rotation.from_matrix(contact.rotation @ before.T).magnitude()
    assert 0 < angle * tool.reach <= 0.25 * tool.inner_radius * 1.0001


@pytest.mark.parametrize("name", list(TOOLS))
def test_distances_are_those_of_the_reference(name):
    tool = TOOLS[name]
    points = np.random.default_rng(1).uniform(-1.5, 1.5, (500, 3)) * tool.reach
    expected, normals = tool.distance(points)
    native = NativeTool(tool.core, tool.radius)
    distances, found = native.distance(points)
    np.testing.assert_allclose(distances, expected, atol=1e-12)
    # Where two faces are equally near, either normal is one.
    alike = np.einsum("px,px->p", found, normals) > 1 - 1e-9
    assert alike.mean() > 0.99
    assert native.stride == pytest.approx(0.25 * tool.inner_radius)


def test_a_body_that_is_not_whole_is_refused(body):
    with pytest.raises(PalpateError, match=r"sphere.*whole=True"):
        native_tool(body, native_body(body), TOOLS["sphere"])


def test_wrong_arrays_are_refused(body, surface):
    points, correction = surface_and_correction(body, TOOLS["sphere"])
    arrays = [points.positions, points.normals, points.triangles, points.alphas, points.areas]
    ToolSurface(surface, *arrays)
    with pytest.raises(ValueError, match=r"positions, .* areas; give each as many rows"):
        ToolSurface(surface, *arrays[:-1], points.areas[1:])
    near = correction.arrays()
    for name, remark in {"own": "a row for each", "normals": "a row for each"}.items():
        with pytest.raises(ValueError, match=remark):
            ToolSurface(surface, *arrays, near | {name: near[name][1:]})
    with pytest.raises(ValueError, match="not finite or cannot be; give what"):
        ToolSurface(surface, *arrays, near | {"edges": 0 * near["edges"]})
    with pytest.raises(ValueError, match="near has later, which this palpate_servo does not know"):
        ToolSurface(surface, *arrays, near | {"later": near["own"]})
    with pytest.raises(ValueError, match="near has no shares"):
        ToolSurface(surface, *arrays, {k: near[k] for k in near if k != "shares"})
    contact = ToolContact(ToolSurface(surface, *arrays), NativeTool([[0, 0, 0]], 0.01))
    with pytest.raises(ValueError, match="no rotation"):
        contact.follow([0, 0, 0.2], 2 * np.eye(3), 1e4)
    with pytest.raises(ValueError, match="young_modulus"):
        contact.follow([0, 0, 0.2], np.eye(3), 0.0)
    with pytest.raises(ValueError, match="65 core points"):
        NativeTool(np.zeros((65, 3)), 0.01)


def test_a_tick_that_is_replayed_comes_out_the_same_and_no_longer(body, surface):
    tool = TOOLS["sphere"]
    made = native_tool(body, surface, tool)
    contact, other = (ToolContact(*made, friction=0.3) for _ in range(2))
    places = highest_place(body) + [0.0, 0.0, 1.0] * np.linspace(0.02, 0.014, 450)[:, None]
    turns = np.tile(np.eye(3), (450, 1, 1))
    once = tool_costs(contact, places, turns, 1e4)
    # Every tick is longer than nothing: all are replayed. One that differed would be an error.
    again = tool_costs(other, places, turns, 1e4, replay_over=0.0, control=1e-6)
    np.testing.assert_array_equal(once["multiplications"], again["multiplications"])
    np.testing.assert_array_equal(contact.force, other.force)
    assert again["pressed"].max() > 0
    assert (again["computing"] <= again["taken"]).all()
    np.testing.assert_array_equal(once["computing"], once["taken"])
    np.testing.assert_array_equal(np.flatnonzero(again["copied"]), [0, 180, 380])
    assert not once["copied"].any()
    assert again["control"].shape == (113,)
    assert once["control"].shape == (0,)


@pytest.mark.parametrize("tool", [sphere(0.007), rod(0.006, 0.01)], ids=["sphere", "rod"])
def test_in_an_inner_corner_it_comes_to_rest_where_the_engine_does(tool):
    """Beside a floor 3 mm deep a wall is approached, touched, and left again."""
    corner = inner_corner()
    contact = ToolContact(*native_tool(corner, native_body(corner, whole=True), tool))
    low, left = tool.core.min(axis=0)[[2, 0]] - tool.radius
    poses = [Pose.at([0.025 - left - into, 0.025, 0.022 - low]) for into in (-5e-4, 6e-4, -1e-4)]
    press, above = Press(corner, [tool]), Pose.at(poses[0].position + np.array([0.0, 0.0, 0.004]))
    press.to([above])
    contact.restart(above.position, above.rotation)
    aside = []
    for goal in poses:
        (touch,) = press.to([goal])
        settled(contact, goal, corner.young_modulus)
        scale = float(np.linalg.norm(touch.force))
        np.testing.assert_allclose(contact.force, touch.force, atol=1e-5 * scale)
        aside.append(touch.force[0] / scale)
    assert abs(aside[0]) < 0.05
    assert aside[1] > aside[0] + 0.05


def test_a_surface_that_another_finger_has_bulged_is_met_where_it_has_gone():
    """One pushes a strip 3 mm aside, the other comes from beyond: no step, and the engine's."""
    strip, tool = soft_block((0.06, 0.008, 0.04), (8, 2, 6)), sphere(0.012)
    native = native_body(strip, whole=True)

    def places(depth, gap):
        return np.array([[0.029, y, 0.03] for y in (depth - tool.radius, 0.02 + gap)])

    fingers = SteppedFingers(native, places(-0.001, 0.006), Settings(strip.young_modulus))
    for finger in (0, 1):
        fingers.set_tool(native_tool(strip, native, tool), np.eye(3), finger)
    fingers.follow(np.array([places(depth, 0.006) for depth in np.linspace(-0.001, 0.003, 150)]))
    coming = np.array([places(0.003, gap) for gap in np.linspace(0.006, 0.0023, 400)])
    forces, _ = fingers.follow(coming)
    meeting, alone = forces[:, 1, 1], forces[0, 0, 1]
    assert meeting[0] == 0.0
    press = Press(strip, [tool, tool])
    for gap in (0.006, 0.0023):
        touches = press.to([Pose.at(place) for place in places(0.003, gap)])
    expected = touches[1].force[1]
    forces, _ = fingers.follow(np.repeat(coming[-1:], 200, axis=0))
    near, far = forces[-1, :, 1]
    assert far == pytest.approx(expected, rel=1e-3)
    # What one pushes the other holds, but for what the strip bears by itself.
    assert near < 1.5 * alone < 0 < far
    assert near + far == pytest.approx(alone, rel=0.5)
    assert np.abs(np.diff(meeting)).max() < 0.03 * expected
