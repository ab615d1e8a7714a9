"""Animate Dents: one after the other, by keyframes that other dents do not change."""

from __future__ import annotations

import bpy
import numpy as np
from soft_scene import TOP, cube, error_of, layer_names, moved, part, press_down


def strengths(thing, frame):
    bpy.context.scene.frame_set(frame)
    layers = part("operators.layer.layers")
    return [layers.strength(layer) for layer in layers.layers_of(thing)]


def test_dents_come_one_after_the_other_and_later_ones_follow(thing):
    stroke = {"motion": "PUSH", "place": TOP, "radius": 0.02, "depth": 0.003}
    bpy.ops.palpate.stroke(**stroke)
    bpy.ops.palpate.stroke(**stroke)
    bpy.context.scene.frame_set(5)
    assert bpy.ops.palpate.animate_layers(frames=10) == {"FINISHED"}
    assert bpy.context.scene.frame_current == 25
    assert strengths(thing, 5) == [0.0, 0.0]
    assert strengths(thing, 15) == [1.0, 0.0]
    assert strengths(thing, 25) == [1.0, 1.0]
    bpy.ops.palpate.stroke(**stroke)
    assert layer_names(thing)[-1] == "Press 3"
    bpy.ops.palpate.animate_layers(frames=10)
    assert strengths(thing, 15) == [1.0, 0.0, 0.0]
    assert strengths(thing, 35) == [1.0, 1.0, 1.0]
    assert "animated" in error_of(bpy.ops.palpate.animate_layers)


def test_a_material_is_chosen_with_make_soft(palpate):
    thing = cube()
    softest = min(materials().items(), key=lambda item: item[1].young_modulus)[0]
    assert bpy.ops.palpate.make_soft(material=softest) == {"FINISHED"}
    assert thing.palpate.material == softest
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert thing.palpate.material == softest


def materials():
    return part("core.softness.scales.materials").MATERIALS


def test_a_removed_dent_leaves_neither_attribute_nor_keyframes(palpate, thing):
    press_down(thing)
    press_down(thing)
    attributes = {"Press 1", "Press 2"}
    assert attributes <= set(thing.data.attributes.keys())
    bpy.ops.palpate.animate_layers(frames=10)
    second = moved(thing, "Press 2")
    assert bpy.ops.palpate.remove_layer(layer="Press 1") == {"FINISHED"}
    assert layer_names(thing) == ["Press 2"]
    assert attributes & set(thing.data.attributes.keys()) == {"Press 2"}
    np.testing.assert_array_equal(moved(thing, "Press 2"), second)
    # The next dent takes the name, and stands still.
    press_down(thing)
    assert set(layer_names(thing)) == {"Press 1", "Press 2"}
    layers, curves = part("operators.layer.layers"), part("operators.scene.curves")
    animated = [
        curves.is_animated(thing, layers.strength_path(thing.modifiers[name]))
        for name in ("Press 1", "Press 2")
    ]
    assert animated == [False, True]


def test_a_dent_that_is_not_there_is_not_removed(palpate, thing):
    press_down(thing)
    assert "no layer 'Press 7'" in error_of(lambda: bpy.ops.palpate.remove_layer(layer="Press 7"))
    assert layer_names(thing) == ["Press 1"]
