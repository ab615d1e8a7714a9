"""Imprints of an object that nobody pins and a hand steadies: the next stroke meets them."""

from __future__ import annotations

import bpy
import pytest
from soft_scene import cube, layer_names, moved, part

# A vertex: no node of the body can be pressed deeper than it.
TOP, RADIUS, YIELD = (0.005, 0.0, 0.025), 0.012, 0.001


@pytest.fixture
def clay(palpate):
    """A cube whose faces have vertices 5 mm apart, without pins, which remembers."""
    thing = cube()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=9)
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.palpate.pin_mode, thing.palpate.steady = "NONE", True
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    thing.palpate.yield_depth = YIELD
    return thing


def push(depth):
    assert bpy.ops.palpate.stroke(place=TOP, radius=RADIUS, depth=depth) == {"FINISHED"}


def test_the_next_push_goes_on_from_the_imprint(clay):
    push(0.004)
    first = moved(clay, "Press 1")
    deepest = first[:, 2].argmin()
    left = -first[deepest, 2]
    assert 0.0015 < left < 0.0045
    # The body that is pressed next has it.
    drawn = part("operators.object.drawn_body").open_body(clay, bpy.context.scene)
    lowered = drawn.at_rest.mesh.nodes[:, 2] - drawn.body.mesh.nodes[:, 2]
    assert 0.1 * left < lowered.max() <= 1.05 * left
    push(0.004)
    assert layer_names(clay) == ["Rests", "Press 1", "Press 2"]
    both = (first + moved(clay, "Press 2"))[:, 2].min()
    assert 1.3 * left < -both < 2.7 * left


def test_without_a_hand_it_meets_none(clay):
    push(0.004)
    clay.palpate.steady = False
    drawn = part("operators.object.drawn_body").open_body(clay, bpy.context.scene)
    assert drawn.body is drawn.at_rest
