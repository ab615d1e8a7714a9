"""Soft objects that rest on each other come to rest together, and are brought back together."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import body_of, error_of, layer_names, part, rest_places, seen_places, select

WEIGHT_SHARE = 2e-5


def settle(*things):
    """Settle as the operator does, and return where each lies."""
    act = part("operators.rest.settle").settle
    return act(list(things), bpy.context.evaluated_depsgraph_get())


def weight_of(thing):
    return thing.palpate.density * body_of(thing).inertia.volume * 9.81


def test_two_cubes_come_to_rest_on_each_other_in_one_step(free_cube, stack):
    upper = stack()
    before = [one.matrix_world.copy() for one in (free_cube, upper)]
    select(upper)
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    assert free_cube.location.z == pytest.approx(0.025, abs=1e-3)
    assert upper.location.z == pytest.approx(0.075, abs=4e-3)
    for one in (free_cube, upper):
        assert layer_names(one) == ["Rests"]
        sag = np.abs(seen_places(one) - rest_places(one)).max()
        assert 1e-5 < sag < 4e-3
    # Reset of one brings back all that it rests with.
    assert bpy.ops.palpate.reset_rest() == {"FINISHED"}
    assert [one.matrix_world for one in (free_cube, upper)] == before
    assert layer_names(free_cube) == layer_names(upper) == []


def test_each_bears_what_lies_on_it(free_cube, stack):
    upper = stack()
    upper.palpate.density *= 2.0
    lower_lies, upper_lies = settle(free_cube, upper)
    over, under = weight_of(upper), weight_of(free_cube)
    limit = WEIGHT_SHARE * over
    np.testing.assert_allclose(lower_lies.rest.others[1].force, [0, 0, over], atol=limit)
    np.testing.assert_allclose(upper_lies.rest.others[0].force, [0, 0, -over], atol=limit)
    np.testing.assert_allclose(lower_lies.rest.supports[0].force, [0, 0, -over - under], atol=limit)


def test_a_pinned_object_bears_others_and_gives_way_where_it_is(free_cube, stack):
    upper = stack()
    free_cube.palpate.pin_mode = "BELOW"
    select(free_cube)
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    free_cube.location.z = 0.2
    upper.location.z = 0.2502
    bpy.context.view_layer.update()
    place = free_cube.matrix_world.copy()
    select(upper)
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    assert free_cube.matrix_world == place
    assert upper.location.z == pytest.approx(0.25, abs=4e-3)
    assert layer_names(free_cube) == ["Rests"]
    assert np.abs(seen_places(free_cube) - rest_places(free_cube)).max() > 1e-5


def test_selected_ones_settle_together_and_rigid_colliders_bear_all(free_cube, board):
    other = free_cube.copy()
    other.palpate.colliders = None
    bpy.context.collection.objects.link(other)
    free_cube.location.z, other.location = 0.33, (0.08, 0.0, 0.335)
    board(at=(0.0, 0.0, 0.3))
    other.select_set(True)
    bpy.context.view_layer.update()
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    for one in (free_cube, other):
        assert one.location.z == pytest.approx(0.325, abs=1e-3)


def test_high_above_the_ground_the_way_down_is_left_out(free_cube, stack):
    upper = stack()
    for one in (free_cube, upper):
        one.location.z += 50.0
    bpy.context.view_layer.update()
    lying = settle(free_cube, upper)
    assert upper.location.z == pytest.approx(0.075, abs=4e-3)
    assert lying[0].rest.time < 5.0


def test_one_that_cannot_move_leaves_all_where_they_are(free_cube, stack):
    upper = stack()
    free_cube.keyframe_insert("location")
    select(upper)
    before = upper.matrix_world.copy()
    assert "placed by its animation" in error_of(bpy.ops.palpate.settle)
    assert upper.matrix_world == before
    assert layer_names(upper) == []
