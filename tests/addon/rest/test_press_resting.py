"""Presses by scripts of objects that nobody holds: they rest, are pressed, and rest again."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, mesh_state, moved, part, select

RADIUS, TOP, BY = 0.012, (0.004, 0.002, 0.025), (0.0, 0.0, -0.003)


@pytest.fixture
def tip(free_cube):
    chosen = bpy.context.scene.palpate
    chosen.tip, chosen.own_sizes, chosen.tip_radius = "SPHERE", True, RADIUS
    return chosen


def state(thing):
    return mesh_state(thing), np.array(thing.matrix_world).tolist(), thing.palpate.is_laid


def pressed(thing, at=TOP, by=BY, **more):
    return part("operators.press.press_once").press_once(thing, bpy.context.scene, at, by, **more)


def test_the_force_is_that_of_the_engine_alone(free_cube, tip):
    made = pressed(free_cube)
    rest, tools = part("core.rest.resting"), part("core.contact.tool.tools")
    pose, support = part("core.contact.tool.pose").Pose, part("core.rest.support")
    body = part("operators.object.drawn_body").open_body(free_cube, bpy.context.scene).body
    settings = rest.RestSettings(free_cube.palpate.young_modulus, 0.5)
    floor = support.Floor(-0.025, 0.5)
    alone = rest.Resting(body, [floor], settings=settings).settle()
    top = alone.surface()[:, 2].max()
    start = np.array([TOP[0], TOP[1], top + RADIUS + 2e-3])
    tool = [(tools.sphere(RADIUS), pose(start, np.eye(3)))]
    led = rest.Resting(body, [floor], tool, placement=alone.placement, settings=settings)
    led.settle()
    led.lead([pose(start - (0.0, 0.0, 0.005), np.eye(3))])
    expected = np.asarray(led.settle().tools[0].force)
    # The place may lie a little higher or lower than the highest of the surface.
    assert np.linalg.norm(made.force - expected) < 0.1 * np.linalg.norm(expected)
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
    before = state(free_cube)
    assert np.linalg.norm(pressed(free_cube, keep=False).force) > 0.0
    assert state(free_cube) == before


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


def test_what_bears_it_gives_way_too(free_cube, colliders, tip):
    free_cube.location.z = 0.0255
    upper = free_cube.copy()
    bpy.context.collection.objects.link(upper)
    upper.location = (0.0, 0.0, 0.076)
    for one in (free_cube, upper):
        colliders.objects.link(one)
    bpy.context.view_layer.update()
    made = pressed(upper, (0.004, 0.002, 0.101), (0.0, 0.0, -0.003))
    assert layer_names(upper) == ["Rests", "Press 1"]
    assert layer_names(free_cube) == ["Rests"]
    on_floor = part("operators.press.press_once")
    lonely = upper.copy()
    bpy.context.collection.objects.link(lonely)
    lonely.palpate.colliders = None
    lonely.location = (0.5, 0.0, 0.03)
    for name in layer_names(lonely):
        lonely.modifiers.remove(lonely.modifiers[name])
    bpy.context.view_layer.update()
    firm = on_floor.press_once(
        lonely, bpy.context.scene, (0.504, 0.002, 0.055), (0.0, 0.0, -0.003), keep=False
    )
    assert 0.3 < made.force[2] / firm.force[2] < 0.95


def test_a_point_is_refused_with_the_remedy(free_cube):
    bpy.context.scene.palpate.tip = "POINT"
    before = state(free_cube)
    assert "another Finger" in error_of(bpy.ops.palpate.press, at=TOP, by=BY)
    assert state(free_cube) == before


def test_nothing_has_moved_where_it_finds_no_rest(free_cube, tip):
    free_cube.palpate.floor = "NONE"
    before = state(free_cube)
    error_of(bpy.ops.palpate.press, at=TOP, by=BY)
    assert state(free_cube) == before


def test_one_that_springs_back_is_given_back(free_cube, tip):
    free_cube.palpate.yield_depth = 0.02
    before = state(free_cube)
    assert "springs back" in error_of(bpy.ops.palpate.press, at=TOP, by=BY)
    assert state(free_cube) == before
