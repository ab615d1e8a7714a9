"""Other pins after the bake: taken over without one where that is possible, and said which."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    body_of,
    cube,
    error_of,
    locate,
    moved,
    press_down,
    select,
    soft_cube,
    status,
)


def fit(thing):
    return status(thing).pins.fit.name


@pytest.fixture
def soft(palpate):
    return soft_cube()


def test_more_pins_take_effect_without_a_bake_as_a_bake_would_have_them(soft):
    old = body_of(soft)
    soft.palpate.pin_fraction = 0.4
    assert fit(soft) == "MORE"
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    assert fit(soft) == "SAME"
    body = body_of(soft)
    assert len(body.fixed) > len(old.fixed)
    assert body.mesh.nodes[body.fixed, 2].max() > -0.025 + 0.3 * 0.05
    key, table = soft.palpate.body_key, body.compliance.columns(np.arange(20))
    locate(soft).unlink()
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert soft.palpate.body_key == key
    baked = body_of(soft).compliance.columns(np.arange(20))
    assert np.abs(baked - table).max() < 1e-4 * np.abs(baked).max()


def test_pins_that_were_baked_before_need_nothing(soft):
    first = soft.palpate.body_key
    soft.palpate.pin_fraction = 0.4
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    assert soft.palpate.body_key != first
    soft.palpate.pin_fraction = 0.1
    assert fit(soft) == "KNOWN"
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    assert soft.palpate.body_key == first
    assert status(soft).pins.fit.name == "SAME"


def test_fewer_pins_need_a_bake_and_keep_the_tetrahedra(soft):
    tets = np.array(soft.palpate["tets"])
    soft.palpate.pin_fraction = 0.4
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    soft.palpate.pin_fraction = 0.2
    assert fit(soft) == "LESS"
    assert "Rebuild Body" in error_of(bpy.ops.palpate.update_pins)
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert fit(soft) == "SAME"
    assert np.array_equal(np.array(soft.palpate["tets"]), tets)


def test_pins_elsewhere_need_a_bake(soft):
    soft.vertex_groups.new(name="Top").add(
        [v.index for v in soft.data.vertices if v.co.z > 0], 1.0, "REPLACE"
    )
    soft.palpate.pin_mode, soft.palpate.pin_group = "GROUP", "Top"
    assert fit(soft) == "OTHER"


def test_pins_that_hold_nothing_or_everything_are_refused_with_a_remedy(soft):
    soft.palpate.pin_mode, soft.palpate.pin_group = "GROUP", "Nothing"
    assert fit(soft) == "UNUSABLE"
    message = error_of(bpy.ops.palpate.update_pins)
    assert "vertex group" in message
    assert message.count(soft.name) == 1
    soft.vertex_groups.new(name="All").add(range(len(soft.data.vertices)), 1.0, "REPLACE")
    soft.palpate.pin_group = "All"
    assert "pin less" in error_of(bpy.ops.palpate.update_pins)
    assert fit(soft) == "UNUSABLE"


def test_press_takes_more_pins_over_by_itself(soft):
    press_down(soft)
    free = moved(soft, "Press 1")
    top = [v.index for v in soft.data.vertices if v.co.z > 0]
    assert np.linalg.norm(free[top], axis=1).min() > 0
    group = soft.vertex_groups.new(name="Corner")
    group.add([v.index for v in soft.data.vertices if v.co.z < 0 or v.index == top[0]], 1.0, "ADD")
    soft.palpate.pin_mode, soft.palpate.pin_group = "GROUP", "Corner"
    # Not in the middle: there the weight is a half, and all nodes of a triangle may be pinned.
    away = (0.0125, 0.0125, 0.025)
    assert bpy.ops.palpate.press(at=away, by=(0.0, 0.0, -0.005)) == {"FINISHED"}
    assert fit(soft) == "SAME"
    held = moved(soft, "Press 2")
    assert np.abs(held[top[0]]).max() < 1e-7
    assert np.linalg.norm(held[top[1]]) > 0


def test_other_changes_wait_for_rebuild_body_and_pins_with_them(soft):
    key = soft.palpate.body_key
    soft.palpate.pin_fraction, soft.palpate.poisson_ratio = 0.4, 0.2
    press_down(soft)
    assert soft.palpate.body_key == key
    assert len(status(soft).changed) == 1


def test_another_rule_that_pins_the_same_is_no_change(soft):
    soft.palpate.pin_fraction = 0.1001
    assert fit(soft) == "SAME"


def test_what_is_soft_no_more_or_not_yet_has_no_pins_to_update(palpate):
    thing = cube()
    assert "not soft yet" in error_of(bpy.ops.palpate.update_pins)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    thing.scale = (2, 1, 1)
    select(thing)
    assert "Make Soft" in error_of(bpy.ops.palpate.update_pins)
