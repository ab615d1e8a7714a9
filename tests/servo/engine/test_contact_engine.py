"""Fingers without a clock press as the references of core say, and as the servo does."""

import numpy as np
import pytest
from native_tip import native_tip
from palpate_servo import ContactEngine

from palpate.core.contact.tool.tool_contact import press_tool
from palpate.core.contact.tool.tools import Pose, plate, rod, sphere


def places_on(body):
    """Triangles, area coordinates, and ways 2 mm into the body, of two places."""
    at = body.mesh.nodes[body.mesh.surface_nodes]
    far = at[[at[:, 2].argmax(), at[:, 0].argmax()]] + 1e-3
    places = body.closest_points.query(far)
    middle = body.mesh.nodes.mean(axis=0)
    ways = middle - far
    return places.triangle, places.alpha, 0.002 * ways / np.linalg.norm(ways, axis=1)[:, None]


@pytest.mark.parametrize("mode", ["consistent", "paper"])
def test_points_are_those_of_the_paper(body, surface, mode):
    triangles, alphas, ways = places_on(body)
    engine = ContactEngine(surface, [None, None], young_modulus=body.young_modulus, mode=mode)
    settled = engine.settle(list(zip(triangles, alphas, ways, strict=True)))
    corners = body.mesh.nodes[body.mesh.surface_triangles[triangles]]
    places = np.einsum("pc,pcx->px", alphas, corners)
    touches = body.touch_several(places, ways, mode=mode)
    for one, touch in zip(settled, touches, strict=True):
        scale = np.linalg.norm(touch.force)
        np.testing.assert_allclose(one["force"], touch.force, atol=1e-9 * scale)
        # On an edge either of its triangles may be told.
        for node, force in zip(touch.triangle, touch.nodal_forces, strict=True):
            told = one["nodal_forces"][body.mesh.surface_nodes[one["nodes"]] == node].sum(axis=0)
            np.testing.assert_allclose(told, force, atol=1e-9 * scale)


@pytest.mark.parametrize("tool", [sphere(0.018), rod(0.014, 0.015), plate(0.016, 0.016)])
def test_a_tool_is_the_references(body, surface, tool):
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    top = nodes[nodes[:, 2].argmax()]
    lowest = float(tool.core[:, 2].min() - tool.radius)
    pose = Pose.at(top - [0.0, 0.0, lowest + 0.003])
    engine = ContactEngine(
        surface, [native_tip(body, surface, tool)], young_modulus=body.young_modulus
    )
    (settled,) = engine.settle([(pose.position, pose.rotation)])
    touch = press_tool(body, tool, pose)
    scale = np.linalg.norm(touch.force)
    np.testing.assert_allclose(settled["force"], touch.force, atol=1e-7 * scale)
    np.testing.assert_allclose(settled["torque"], touch.torque, atol=1e-7 * scale * tool.reach)
    np.testing.assert_array_equal(np.sort(settled["points"]), touch.points)
    np.testing.assert_allclose(
        settled["nodal_forces"].sum(axis=0), -settled["force"], atol=1e-12 * scale
    )
