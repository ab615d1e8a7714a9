"""Several tools and points are one problem: least energy, at rest at once, no double firmness."""

import numpy as np
import pytest
from bodies.soft_block import soft_block
from least_energy import Held, least_energy
from native_tip import native_tip
from palpate_servo import ContactEngine
from palpate_servo.harness import SteppedFingers

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate, rod, sphere
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings

TOP, MIDDLE = 0.05, [0.0262, 0.0243]
TIP = sphere(0.012)
# Poses on the paper's cube: from above, from either side, and two beside each other.
PRESSES = {
    "one": [[*MIDDLE, TOP + 0.0095]],
    "pinch": [[0.0262, TOP + 0.01, 0.03], [0.0242, -0.009, 0.031]],
    "beside": [[0.012, 0.0243, TOP + 0.0095], [0.036, 0.0243, TOP + 0.01]],
}


def pressed(body, native, tools, places, held=()):
    """Forces on tools at places and on held points, N, all of them at once."""
    tips = [native_tip(body, native, tool) for tool in tools] + [None] * len(held)
    engine = ContactEngine(native, tips, young_modulus=body.young_modulus)
    goals = [(place, np.eye(3)) for place in places]
    points = [(one.triangle, one.alpha, one.by) for one in held]
    return np.array([one["force"] for one in engine.settle(goals + points)])


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name == "pinch" else pytest.mark.at_length)
        for name in PRESSES
    ],
)
def test_tools_find_the_least_energy(cube_body, whole, name):
    places = PRESSES[name]
    expected, _ = least_energy(cube_body, [(TIP, Pose.at(place)) for place in places])
    found = pressed(cube_body, whole, [TIP] * len(places), places)
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())


def test_a_tool_and_a_point_find_the_least_energy_together(cube_body, whole):
    place = cube_body.closest_points.query(np.array([[0.04, 0.04, TOP]]))
    held = Held(int(place.triangle[0]), place.alpha[0], np.array([0.001, 0.0, -0.002]))
    at = [*MIDDLE, TOP + 0.0095]
    on_tool, on_point = least_energy(cube_body, [(TIP, Pose.at(at))], [held])
    found = pressed(cube_body, whole, [TIP], [at], [held])
    expected = np.vstack([on_tool, on_point])
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())
    alone = pressed(cube_body, whole, [TIP], [at])
    assert np.linalg.norm(found[0] - alone[0]) > 0.05 * np.linalg.norm(alone)


@pytest.mark.parametrize(
    "tool", [sphere(0.004), sphere(0.008), rod(0.006, 0.012), plate(0.016, 0.016)]
)
@pytest.mark.parametrize("depth", [0.0005, 0.002])
def test_two_tools_on_one_place_are_felt_as_one(cube_body, whole, tool, depth):
    at = np.array([*MIDDLE, TOP - float(tool.core[:, 2].min()) + tool.radius - depth])
    one = pressed(cube_body, whole, [tool], [at])[0]
    two = pressed(cube_body, whole, [tool, tool], [at, at])
    np.testing.assert_allclose(two.sum(axis=0), one, atol=0.01 * np.linalg.norm(one))
    np.testing.assert_allclose(two[0], two[1], atol=1e-6 * np.linalg.norm(one))
    # A hair's breadth deeper carries a little more, not all.
    deeper = pressed(cube_body, whole, [tool, tool], [at, at - [0.0, 0.0, 1e-4 * depth]])
    assert 0.5 * one[2] < deeper[1, 2] < 0.55 * one[2]


def test_overlapping_tools_are_felt_as_their_common_shape(cube_body, whole):
    places = [[*MIDDLE, TOP + 0.0095], [MIDDLE[0] + 0.004, MIDDLE[1], TOP + 0.0098]]
    expected, _ = least_energy(cube_body, [(TIP, Pose.at(place)) for place in places])
    found = pressed(cube_body, whole, [TIP, TIP], places).sum(axis=0)
    expected = expected.sum(axis=0)
    np.testing.assert_allclose(found, expected, atol=0.005 * np.linalg.norm(expected))


@pytest.mark.parametrize(("bent", "squeezed"), [(0.006, 0.001), (0.006, 0.003), (0.0015, 0.003)])
def test_through_a_thin_plate_two_tools_are_at_rest_within_ten_ticks(bent, squeezed):
    """6 mm thin, also bent by its thickness and squeezed to half of it."""
    thin, tool = soft_block((0.06, 0.006, 0.04), (10, 2, 7)), sphere(0.008)
    native = native_body(thin, whole=True)

    def places(bend, squeeze):
        sides = (bend - tool.radius, 0.006 + bend + tool.radius - squeeze)
        return np.array([[0.029, y, 0.03] for y in sides])

    fingers = SteppedFingers(native, places(-0.001, -0.001), Settings(thin.young_modulus))
    for finger in (0, 1):
        fingers.set_tool(native_tool(thin, native, tool), np.eye(3), finger)
    ways = [places(bend, -0.001) for bend in np.linspace(-0.001, bent, 200)]
    ways += [places(bent, squeeze) for squeeze in np.linspace(-0.001, squeezed, 100)]
    fingers.follow(np.array(ways))
    forces, _ = fingers.follow(np.repeat([ways[-1]], 40, axis=0))
    rest = forces[-1]
    assert rest[1, 1] > 0.1
    most = np.abs(rest).max()
    np.testing.assert_allclose(forces[10:], rest[None].repeat(30, 0), atol=1e-5 * most)
    goals = [places(bend, squeeze) for bend, squeeze in ((-0.001, -0.001), (bent, -0.001))]
    tip = native_tip(thin, native, tool)
    engine = ContactEngine(native, [tip, tip], young_modulus=thin.young_modulus)
    for goal in [*goals, ways[-1]]:
        settled = engine.settle([(place, np.eye(3)) for place in goal])
    expected = np.array([one["force"] for one in settled])
    np.testing.assert_allclose(rest, expected, atol=1e-6 * most)
