"""The drawn surface stays out of tools, smoothly, and is left alone elsewhere."""

import numpy as np
import pytest

from palpate.core.body.drawn_map import DrawnMap
from palpate.core.contact.near_field.contact_points import contact_points
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tool_dent import FADE, PressingTool, kept_out
from palpate.core.contact.tool.tools import plate, sphere

RADIUS, DEPTH = 0.008, 0.002
PUSHED = np.array([0.0, 0.0, 1.0])


def plane(count=81, half=0.02):
    line = np.linspace(-half, half, count)
    x, y = (axis.ravel() for axis in np.meshgrid(line, line))
    return np.column_stack([x, y, 0 * x])


def on_plane(depth, force=PUSHED):
    return PressingTool(sphere(RADIUS), Pose.at([0.0, 0.0, RADIUS - depth]), force)


def test_places_in_the_tool_go_onto_its_surface_and_others_stay():
    places, up = plane(), np.tile(PUSHED, (81 * 81, 1))
    drawn = kept_out(places, up, on_plane(DEPTH))
    distances = on_plane(DEPTH).tool.distance(on_plane(DEPTH).pose.to_tool(drawn))[0]
    assert distances.min() > -1e-12
    rest = on_plane(DEPTH).tool.distance(on_plane(DEPTH).pose.to_tool(places))[0]
    fade = min(FADE * RADIUS, -rest.min())
    np.testing.assert_allclose(distances[rest < -fade], 0.0, atol=1e-12)
    np.testing.assert_array_equal(drawn[rest > fade], places[rest > fade])
    # In between nothing stands off by more than the middle of the parabola.
    assert (distances - np.maximum(rest, 0)).max() <= fade / 4 + 1e-12


def test_no_edge_is_drawn_around_the_contact():
    """The slope turns by little from one place to the next, a fiftieth of the radius apart."""
    line = np.linspace(-0.009, 0.009, 113)
    places = np.column_stack([line, 0 * line, 0 * line])
    up = np.tile(PUSHED, (len(line), 1))

    def sharpest(drawn):
        slopes = np.diff(drawn[:, 2]) / np.diff(drawn[:, 0])
        return np.abs(np.diff(np.arctan(slopes))).max()

    bare = places.copy()
    tool = on_plane(DEPTH)
    distance, outward = tool.tool.distance(tool.pose.to_tool(places))
    bare += np.maximum(-distance, 0.0)[:, None] * outward
    assert sharpest(kept_out(places, up, tool)) < 0.5 * sharpest(bare)


def test_contact_begins_without_a_jump():
    places, up = plane(), np.tile(PUSHED, (81 * 81, 1))
    for depth in (1e-3, 1e-4, 1e-5, 1e-6):
        moved = np.linalg.norm(kept_out(places, up, on_plane(depth)) - places, axis=1).max()
        assert 0.0 < moved <= depth * (1 + 1e-9)


def test_what_lies_across_a_thin_part_stays():
    thin = plane() - [0.0, 0.0, 0.0015]
    down = np.tile(-PUSHED, (len(thin), 1))
    np.testing.assert_array_equal(kept_out(thin, down, on_plane(DEPTH)), thin)


def test_a_tool_that_feels_nothing_moves_nothing():
    places, up = plane(), np.tile(PUSHED, (81 * 81, 1))
    np.testing.assert_array_equal(kept_out(places, up, on_plane(DEPTH, np.zeros(3))), places)


@pytest.mark.parametrize(
    "tool",
    [
        pytest.param(sphere(RADIUS), id="sphere"),
        pytest.param(plate(0.016, 0.016), id="plate", marks=pytest.mark.at_length),
    ],
)
def test_a_coarse_body_is_drawn_outside_the_tool(mouse, tool):
    points = contact_points(mouse, 0.001)
    middle = mouse.mesh.nodes.mean(axis=0)
    over = np.linalg.norm((points.positions - middle)[:, :2], axis=1) < 0.003
    top = points.positions[over][points.positions[over, 2].argmax()]
    height = RADIUS if len(tool.core) == 1 else 0.0
    touch = press_tool(mouse, tool, Pose.at(top + np.array([0.0, 0.0, height - 0.003])))
    hung = DrawnMap.hang(points.positions, mouse)
    places = points.positions + hung.displacements(mouse.deform(touch.nodes, touch.nodal_forces))
    normals = hung.normals[hung.triangle]
    drawn = kept_out(places, normals, PressingTool(tool, touch.pose, touch.force))
    inside = [-tool.distance(touch.pose.to_tool(where))[0].min() for where in (places, drawn)]
    assert inside[0] > 0.0003
    assert inside[1] < 1e-9
    moved = np.linalg.norm(drawn - places, axis=1)
    assert np.count_nonzero(moved) < 0.05 * len(places)
