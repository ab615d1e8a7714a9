"""Presses by scripts of objects that nobody holds: they rest, are pressed, and rest again."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, lying_state, moved, part, select

TOP, BY = (0.004, 0.002, 0.025), (0.0, 0.0, -0.003)


def pressed(thing, at=TOP, by=BY, **more):
    return part("operators.press.press_once").press_once(thing, bpy.context.scene, at, by, **more)


def test_the_force_is_that_of_the_engine_alone(free_cube, force_alone, tip):
    made = pressed(free_cube)
    # The place may lie a little higher or lower than the highest of the surface.
    assert np.linalg.norm(made.force - force_alone) < 0.1 * np.linalg.norm(force_alone)
    assert made.force[2] > 0.0
    assert made.fingers[0].depth == pytest.approx(0.003)


def test_a_kept_press_is_a_layer_beside_the_sag(free_cube, tip):
    select(free_cube)
    assert bpy.ops.palpate.press(at=TOP, by=BY) == {"FINISHED"}
    assert layer_names(free_cube) == ["Rests", "Press 1"]
    # Its corners alone are drawn.
    assert 5e-5 < np.abs(moved(free_cube, "Press 1")).max() < 3e-3
    assert free_cube.palpate.is_laid


def test_one_that_is_not_kept_leaves_all_as_it_was(free_cube, tip):
    before = lying_state(free_cube)
    assert np.linalg.norm(pressed(free_cube, keep=False).force) > 0.0
    assert lying_state(free_cube) == before


def test_from_the_side_it_is_pushed_along(free_cube, tip):
    free_cube.palpate.rest_friction = 0.1
    pressed(free_cube, (0.025, 0.0, 0.0), (-0.02, 0.0, 0.0))
    assert -0.025 < free_cube.location.x < -0.005


def test_two_fingers_pinch_it(free_cube, tip):
    select(free_cube)
    pinch = bpy.ops.palpate.pinch(
        at_1=(0.025, 0.0, 0.0), by_1=(-0.002, 0.0, 0.0), at_2=(-0.025, 0.0, 0.0), by_2=(0.002, 0, 0)
    )
    assert pinch == {"FINISHED"}
    assert abs(free_cube.location.x) < 1e-3


def test_what_bears_it_gives_way_too(free_cube, stack, tip):
    upper = stack()
    made = pressed(upper, (0.008, 0.002, 0.101))
    assert layer_names(upper) == ["Rests", "Press 1"]
    assert layer_names(free_cube) == ["Rests"]
    lonely = upper.copy()
    bpy.context.collection.objects.link(lonely)
    lonely.palpate.colliders = None
    lonely.location = (0.5, 0.0, 0.03)
    for name in layer_names(lonely):
        lonely.modifiers.remove(lonely.modifiers[name])
    bpy.context.view_layer.update()
    firm = pressed(lonely, (0.504, 0.002, 0.055), keep=False)
    assert 0.3 < made.force[2] / firm.force[2] < 0.95


def test_a_point_is_refused_with_the_remedy(free_cube):
    bpy.context.scene.palpate.tip = "POINT"
    before = lying_state(free_cube)
    assert "another Finger" in error_of(bpy.ops.palpate.press, at=TOP, by=BY)
    assert lying_state(free_cube) == before


def test_nothing_has_moved_where_it_finds_no_rest(free_cube, tip):
    free_cube.palpate.floor = "NONE"
    before = lying_state(free_cube)
    error_of(bpy.ops.palpate.press, at=TOP, by=BY)
    assert lying_state(free_cube) == before


def test_one_that_springs_back_is_given_back(free_cube, tip):
    free_cube.palpate.yield_depth = 0.02
    before = lying_state(free_cube)
    assert "springs back" in error_of(bpy.ops.palpate.press, at=TOP, by=BY)
    assert lying_state(free_cube) == before
