"""Soft objects with Pressers, for the tests of the installed extension."""

from __future__ import annotations

import bpy
from soft_scene import soft_cube


def tapped_by_ball() -> bpy.types.Object:
    """A soft cube with a ball that goes into and out of its top within the frames 1 to 7."""
    thing = soft_cube()
    ball = sphere("Ball", (0.0, 0.0, 0.07))
    for frame, height in ((1, 0.07), (4, 0.041), (7, 0.07)):
        ball.location.z = height
        ball.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    thing.palpate.pressers = collection("Hand", ball)
    return thing


def sphere(name: str, place: tuple[float, ...], radius: float = 0.02) -> bpy.types.Object:
    """A ball at a place."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=radius, location=place)
    bpy.context.object.name = name
    return bpy.context.object


def collection(name: str, *things: bpy.types.Object) -> bpy.types.Collection:
    """A collection of objects, itself in no scene."""
    made = bpy.data.collections.new(name)
    for thing in things:
        made.objects.link(thing)
    return made
