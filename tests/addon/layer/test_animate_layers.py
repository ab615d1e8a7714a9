"""Animate Dents: one after the other, by keyframes that other dents do not change."""

from __future__ import annotations

import bpy
from soft_scene import TOP, cube, error_of, layer_names, part


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
