"""Modifiers of Palpate's that somebody deletes in Blender's own stack leave nothing for long."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from pressed_scene import tapped_by_ball
from soft_scene import error_of, layer_names, part, press_down, select


def vectors(thing):
    return sorted(one.name for one in thing.data.attributes if one.data_type == "FLOAT_VECTOR")


@pytest.fixture
def plain(thing):
    """Attributes before anything was pressed, one of them the user's and named as Palpate would."""
    thing.data.attributes.new("Press 9", "FLOAT_VECTOR", "POINT")
    return vectors(thing)


@pytest.mark.parametrize("forces", [False, True])
def test_the_next_press_takes_the_attributes_away(thing, plain, forces):
    thing.palpate.force_attributes = forces
    press_down(thing)
    press_down(thing)
    assert layer_names(thing) == ["Press 1", "Press 2"]
    thing.modifiers.remove(thing.modifiers["Press 1"])
    kept = part("operators.layer.layers").displacement(thing, thing.modifiers["Press 2"]).copy()
    press_down(thing)
    assert layer_names(thing) == ["Press 2", "Press 1"]
    layers = part("operators.layer.layers")
    np.testing.assert_array_equal(layers.displacement(thing, thing.modifiers["Press 2"]), kept)
    thing.modifiers.clear()
    press_down(thing)
    assert layer_names(thing) == ["Press 1"]
    assert [one for one in vectors(thing) if not one.startswith("Press 1")] == plain
    assert bpy.ops.palpate.remove_layer(layer="Press 1") == {"FINISHED"}
    assert vectors(thing) == plain
    assert not thing.data.keys()


def test_what_a_linked_copy_still_shows_stays(thing, plain):
    press_down(thing)
    twin = thing.copy()
    bpy.context.collection.objects.link(twin)
    thing.modifiers.clear()
    press_down(thing)
    assert layer_names(thing) == ["Press 2"]
    shown = part("operators.layer.layers").displacement(twin, twin.modifiers["Press 1"])
    assert np.abs(shown).max() > 1e-4


def test_a_rig_leaves_nothing_either(thing, plain):
    place = {"use_cursor": False, "at": (0.0, 0.0, 0.025), "radius": 0.02}
    assert bpy.ops.palpate.add_press_rig(**place) == {"FINISHED"}
    thing.modifiers.clear()
    assert bpy.ops.palpate.add_press_rig(**place) == {"FINISHED"}
    assert [one.name for one in thing.modifiers] == ["Push 1"]
    thing.modifiers.clear()
    press_down(thing)
    assert bpy.ops.palpate.remove_layer(layer="Press 1") == {"FINISHED"}
    assert vectors(thing) == plain


def test_pressers_that_are_taken_away_press_no_more(palpate):
    thing, scene = select(tapped_by_ball()), bpy.context.scene
    scene.frame_set(4)
    assert layer_names(thing) == ["Palpate Pressers"]
    assert "Select a mesh object with layers" in error_of(bpy.ops.palpate.animate_layers)
    assert bpy.ops.palpate.remove_layer(layer="Palpate Pressers") == {"FINISHED"}
    assert thing.palpate.pressers is None
    for frame in (3, 4):
        scene.frame_set(frame)
        assert layer_names(thing) == []
    assert not [one for one in vectors(thing) if one.startswith("Palpate")]
