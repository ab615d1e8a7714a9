"""Strokes on objects that nobody holds: they give way, move, and are given back."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, mesh_state, part, seen_places, select

TOP, RADIUS = (0.004, 0.002, 0.025), 0.012


def state(thing):
    return mesh_state(thing), np.array(thing.matrix_world).tolist(), thing.palpate.is_laid


def push(thing, depth, place=TOP, **more):
    select(thing)
    return bpy.ops.palpate.stroke(place=place, radius=RADIUS, depth=depth, **more)


def test_a_push_dents_the_object_and_stays_as_a_layer(free_cube):
    assert push(free_cube, 0.003) == {"FINISHED"}
    assert layer_names(free_cube) == ["Rests", "Press 1"]
    layers = part("operators.layer.layers")
    dent = layers.displacement(free_cube, free_cube.modifiers["Press 1"])
    # Its corners alone are drawn.
    assert np.abs(dent).max() > 5e-5
    # What is seen is the sag and the dent together, above the floor.
    bpy.context.view_layer.update()
    matrix = np.array(free_cube.matrix_world)
    low = (seen_places(free_cube) @ matrix[:3, :3].T + matrix[:3, 3])[:, 2].min()
    assert low > -0.025 - 1e-5


def test_the_force_is_that_of_a_body_which_rests(free_cube):
    """By the engine alone, of a cube that lies on a floor."""
    body = part("operators.object.drawn_body").open_body(free_cube, bpy.context.scene)
    rest, tools = part("core.rest.resting"), part("core.contact.tool.tools")
    pose, support = part("core.contact.tool.pose").Pose, part("core.rest.support")
    settings = rest.RestSettings(free_cube.palpate.young_modulus, 0.5)
    floor = support.Floor(-0.025, 0.5)
    alone = rest.Resting(body.body, [floor], settings=settings).settle()
    top = alone.surface()[:, 2].max()
    start = np.array([TOP[0], TOP[1], top + RADIUS + 2e-3])
    pressed = rest.Resting(
        body.body,
        [floor],
        [(tools.sphere(RADIUS), pose(start, np.eye(3)))],
        placement=alone.placement,
        settings=settings,
    )
    pressed.settle()
    pressed.lead([pose(start - (0.0, 0.0, 0.005), np.eye(3))])
    expected = np.linalg.norm(pressed.settle().tools[0].force)
    stroke = part("operators.stroke.answer.free_stroke").FreeStroke
    grips = part("operators.stroke.answer.grips").grips_at(
        body, np.array(TOP), RADIUS, (False, False, False)
    )
    asked = part("operators.stroke.answer.motion")
    begun = stroke.begin(free_cube, body, grips)
    _, made = begun.stroked(asked.Asked(asked.Motion.PUSH, 0.003))
    # The place may lie a little higher or lower than the highest of the surface.
    assert made.force == pytest.approx(expected, rel=0.1)


def test_a_push_from_the_side_moves_it_along(free_cube):
    free_cube.palpate.rest_friction = 0.1
    assert push(free_cube, 0.02, place=(0.025, 0.0, 0.0)) == {"FINISHED"}
    assert -0.025 < free_cube.location.x < -0.005
    assert abs(free_cube.location.y) < 2e-3


def test_the_next_push_begins_where_the_object_is_then(free_cube):
    push(free_cube, 0.003)
    push(free_cube, 0.003, place=(-0.008, 0.0, 0.025))
    assert layer_names(free_cube) == ["Rests", "Press 1", "Press 2"]


@pytest.mark.parametrize(
    "motion",
    [
        {"motion": "GRAB", "by": (0.0, 0.0, 0.01)},
        {"motion": "TWIST", "angle": 0.5},
        {"motion": "PUSH", "depth": -0.003},
    ],
)
def test_what_free_bodies_cannot_do_yet_is_refused_and_nothing_has_changed(free_cube, motion):
    before = state(free_cube)
    message = error_of(bpy.ops.palpate.stroke, place=TOP, radius=RADIUS, **motion)
    assert "only be pushed inward" in message
    assert state(free_cube) == before


def test_a_stroke_that_is_given_up_gives_all_back(free_cube):
    free_cube.location.z = 0.05
    bpy.context.view_layer.update()
    before = state(free_cube)
    body = part("operators.object.drawn_body").open_body(free_cube, bpy.context.scene)
    grips = part("operators.stroke.answer.grips").grips_at(
        body, np.array(TOP), RADIUS, (False, False, False)
    )
    motion = part("operators.stroke.answer.motion")
    live, drawing = part("operators.layer.live_layer"), part("operators.stroke.stroke_drawing")
    begun = part("operators.stroke.answer.free_stroke").FreeStroke.begin(free_cube, body, grips)
    assert state(free_cube) == before
    begun.make_ready(free_cube)
    live.hang(free_cube)
    for depth in (0.001, 0.002, 0.004):
        _, made = begun.towards(motion.Asked(motion.Motion.PUSH, depth))
        drawing.draw(free_cube, body, made)
    assert state(free_cube) != before
    live.remove(free_cube)
    begun.give_back(free_cube)
    bpy.context.view_layer.update()
    assert state(free_cube) == before
