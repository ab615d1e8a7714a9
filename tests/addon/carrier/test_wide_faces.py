"""Flat faces that are wide for a dent are divided, and what becomes of the mesh's own vertices."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import COARSE, error_of, moved, part, rest_places, seen_places, select

RADIUS = 0.05 * 2.0 * np.sqrt(3.0)
NORTH = {"motion": "PUSH", "place": (0.0, 0.0, 1.0), "depth": 0.15, "radius": RADIUS}


@pytest.fixture
def ball(palpate):
    """A flat ball of radius 1: a third of its area has wide faces, all else is finer."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    thing = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for face in thing.data.polygons:
        face.select = face.center.z < 0.3
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.palpate.edge_length = COARSE
    select(thing)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    return thing


def longest_edge(mesh):
    places = np.array([one.co for one in mesh.vertices])
    ends = np.array([list(one.vertices) for one in mesh.edges])
    return np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1).max()


@pytest.mark.at_length
def test_a_dent_among_the_widest_faces_of_a_flat_mesh_is_fine(ball):
    assert longest_edge(ball.data) > 0.4 * RADIUS
    assert bpy.ops.palpate.stroke(**NORTH) == {"FINISHED"}
    assert len(seen_places(ball)) > 3 * len(ball.data.vertices)
    assert longest_edge(ball.palpate.carrier.data) < 0.3 * RADIUS


@pytest.mark.at_length
@pytest.mark.parametrize("act", ["convert_layers", "apply_layers"])
def test_what_a_mesh_can_show_of_its_finer_dents_goes_into_it(ball, act):
    assert bpy.ops.palpate.stroke(**NORTH) == {"FINISHED"}
    own = rest_places(ball) + moved(ball, "Press 1")[: len(ball.data.vertices)]
    assert getattr(bpy.ops.palpate, act)() == {"FINISHED"}
    assert not ball.modifiers
    np.testing.assert_allclose(seen_places(ball), own, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    "act", ["apply_layers", pytest.param("convert_layers", marks=pytest.mark.at_length)]
)
def test_what_a_mesh_cannot_show_is_not_lost_in_it(palpate, act):
    cube = select(bpy.data.objects["Cube"])
    cube.palpate.edge_length = COARSE
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    stroke = {"motion": "PUSH", "place": (0.1, 0.2, 1.0), "depth": 0.15, "radius": 0.25}
    assert bpy.ops.palpate.stroke(**stroke) == {"FINISHED"}
    assert "needs other vertices" in error_of(getattr(bpy.ops.palpate, act))
    assert part("operators.layer.layers").kept_of(cube)
