"""The fit of a body to its mesh, as the panel shows it."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from soft_scene import body_of, cube, error_of, mesh_object, part


def bowl():
    """Half a ball without a lid, which the body fills."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.1)
    ball = bpy.context.object.data
    points = [tuple(vertex.co) for vertex in ball.vertices]
    faces = [tuple(face.vertices) for face in ball.polygons if face.center.z > 0]
    thing = mesh_object(points, faces, "Bowl")
    thing.palpate.edge_length, thing.palpate.epsilon = 0.15, 0.01
    return thing


def warnings_of(thing):
    sentence = part("core.sentence").Sentence
    return [sentence.of_line(line) for line in thing.palpate.bake_warnings.split("\n") if line]


def test_an_open_shell_is_warned_of_with_its_vertex_and_stays_so_after_a_rebuild(palpate):
    thing = bowl()
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    distance = thing.palpate.body_to_mesh
    assert 0.06 < distance < 0.11
    (warning,) = [told for told in warnings_of(thing) if told.startswith("the body lies")]
    at = body_of(thing).fit.body_at
    used = {index for face in thing.data.polygons for index in face.vertices}
    away = {
        index: (thing.data.vertices[index].co - Vector((at.x, at.y, at.z))).length for index in used
    }
    assert np.isclose(away[warning.values["vertex"]], min(away.values()), rtol=1e-6)
    thing.palpate.poisson_ratio = 0.4
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert [told for told in warnings_of(thing) if told.startswith("the body lies")]
    assert np.isclose(thing.palpate.body_to_mesh, distance, rtol=1e-3)


def test_what_blender_has_rounded_far_from_the_origin_is_refused(palpate):
    thing = cube(0.05)
    for vertex in thing.data.vertices:
        vertex.co.x += 1e4
    assert "detail is lost" in error_of(bpy.ops.palpate.make_soft)
