"""Faces that are divided for a dent are shaded as they were, as long as there is none."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from numpy.typing import NDArray
from soft_scene import part

LEVEL = 2
# Blender keeps normals that turn with the mesh as pairs of short integers.
DEGREES = 0.1


def ball(*, smooth: bool) -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=10, ring_count=5)
    thing = bpy.context.object
    thing.data.polygons.foreach_set("use_smooth", [smooth] * len(thing.data.polygons))
    return thing


def custom() -> bpy.types.Object:
    thing, rng = ball(smooth=True), np.random.default_rng(15)
    towards = [np.array(one.co) + 0.3 * rng.normal(size=3) for one in thing.data.vertices]
    thing.data.normals_split_custom_set_from_vertices([tuple(one) for one in towards])
    return thing


def corners(thing: bpy.types.Object) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Places and normals of the corners of all faces, as evaluated."""
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    normals = np.empty(3 * len(mesh.loops), dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", normals)
    places = np.array([mesh.vertices[one.vertex_index].co for one in mesh.loops], dtype=np.float32)
    return places, normals.reshape(-1, 3)


def divide(thing: bpy.types.Object) -> None:
    groups = part("operators.layer.layer_groups")
    modifier = thing.modifiers.new("Fine", "NODES")
    modifier.node_group = groups.group_of(groups.Kind.FINE)
    part("operators.layer.modifier_inputs").set_value(modifier, groups.LEVEL, LEVEL)


@pytest.mark.parametrize(
    "make",
    [lambda: ball(smooth=True), lambda: ball(smooth=False), custom],
    ids=["smooth", "flat", "custom"],
)
def test_divided_faces_have_the_normals_of_whole_ones(palpate, make):
    thing = make()
    places, before = corners(thing)
    divide(thing)
    finer, after = corners(thing)
    assert len(finer) > 10 * len(places)
    for place, normal in zip(places, before, strict=True):
        here = np.linalg.norm(finer - place, axis=1) < 1e-6
        # Of each face at this place one corner; one of them is of this face.
        assert (after[here] @ normal).max() > np.cos(np.radians(DEGREES))


def test_the_normals_within_a_face_are_between_those_of_its_corners(palpate):
    thing = custom()
    mesh = thing.data
    normals = np.array([one.vector for one in mesh.corner_normals])
    face = mesh.polygons[12]
    middle = np.mean([mesh.vertices[one].co for one in face.vertices], axis=0)
    wanted = normals[list(face.loop_indices)].mean(axis=0)
    divide(thing)
    finer, after = corners(thing)
    here = np.linalg.norm(finer - middle, axis=1) < 1e-5
    assert here.sum() == len(face.vertices)
    turned = after[here] @ wanted / np.linalg.norm(wanted)
    assert turned.min() > np.cos(np.radians(DEGREES))


def test_a_dent_turns_the_normals(palpate):
    thing = ball(smooth=True)
    divide(thing)
    places, before = corners(thing)
    bend = thing.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle = "TWIST", 1.0
    _, after = corners(thing)
    beside = np.abs(places[:, 2]) < 0.1
    # By a part of the twist, about its axis.
    assert np.einsum("cx,cx->c", before, after)[beside].mean() < np.cos(np.radians(1.0))
