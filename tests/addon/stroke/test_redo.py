"""The redo panel strokes what was touched, not what is active once the stroke is undone."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, moved, part, select, soft_cube

PUSH = {"motion": "PUSH", "depth": 0.003, "radius": 0.01}
DOWN = np.array([0.0, 0.0, -1.0])


@pytest.fixture
def other(thing):
    """Another soft cube, the active object, away from the first."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    made = soft_cube()
    made.location.x = 1.0
    return select(made)


def touched(at):
    """What is seen below a place in the world, and what the operator remembers of it."""
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    seen = part("operators.place.seen_place").under_ray(bpy.context.scene, graph, at, DOWN)
    remembered = SimpleNamespace()
    part("operators.stroke.stroke_properties").StrokeProperties.remember(remembered, seen)
    return seen, vars(remembered)


def test_the_object_that_was_touched_is_stroked_again_and_made_active(thing, other):
    seen, remembered = touched((0.01, 0.005, 0.1))
    assert (seen.thing, bpy.context.object) == (thing, other)
    bpy.ops.ed.undo_push(message="before")
    names = thing.name, other.name
    for depth in (0.003, 0.002):
        asked = {**PUSH, **remembered, "depth": depth}
        assert bpy.ops.palpate.stroke("EXEC_DEFAULT", True, **asked) == {"FINISHED"}
        thing, other = (bpy.data.objects[name] for name in names)
        assert (layer_names(thing), layer_names(other)) == (["Press 1"], [])
        assert bpy.context.object == thing
        # As the redo panel does it.
        bpy.ops.ed.undo()
        assert bpy.context.object.name == names[1]


@pytest.mark.usefixtures("other")
def test_an_instance_is_stroked_again_where_it_was_touched(thing):
    group = bpy.data.collections.new("Group")
    group.objects.link(thing)
    made = bpy.data.objects.new("Instance", None)
    made.instance_type, made.instance_collection = "COLLECTION", group
    made.location, made.rotation_euler.z = (0.3, 0.2, 0.0), np.pi / 2.0
    bpy.context.scene.collection.objects.link(made)
    # At x = 0.02 of the object, which is turned to y.
    seen, remembered = touched((0.3, 0.22, 0.1))
    assert seen.thing == thing
    assert bpy.ops.palpate.stroke(**PUSH, **remembered) == {"FINISHED"}
    again = moved(thing, "Press 1")
    part("operators.layer.layers").remove(thing, thing.modifiers["Press 1"])
    select(thing)
    assert bpy.ops.palpate.stroke(**PUSH, place=(0.02, 0.0, 0.025)) == {"FINISHED"}
    np.testing.assert_allclose(again, moved(thing, "Press 1"), atol=1e-5)
    assert np.abs(again).max() > 1e-4


def test_what_was_touched_and_is_gone_is_told(thing, other):
    _, remembered = touched((0.01, 0.005, 0.1))
    bpy.data.objects.remove(thing)
    assert "gone" in error_of(bpy.ops.palpate.stroke, **PUSH, **remembered)
    assert layer_names(other) == []
