"""Soft objects that lie on each other give way: to Settle again, to strokes, along an animation."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, part, sag, seen_places, select

RADIUS = 0.012
# Of friction they know nothing in the first tick: they slide by as much, metres.
GONE = 3e-5


@pytest.fixture
def stacked(stack):
    """A second cube over the first, at rest."""
    other = stack()
    select(other)
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    return other


def matrices(*things):
    return [np.array(one.matrix_world) for one in things]


def test_what_rests_already_stays_while_time_passes(free_cube, stacked):
    """Laid down where they rest bodies overlap by as far as they sag, and were driven apart by it
    within a tick."""
    coming = part("operators.lying.coming_down").begun(
        [free_cube, stacked], bpy.context.evaluated_depsgraph_get(), 1.0
    )
    before = [one.position for one in coming.placements]
    coming.tick(4e-3)
    for one, other in zip(before, coming.placements, strict=True):
        np.testing.assert_allclose(other.position, one, rtol=0.0, atol=GONE)


def test_a_push_on_the_upper_one_squeezes_the_lower_one(free_cube, stacked):
    before, sagged = matrices(free_cube, stacked), sag(free_cube)
    select(stacked)
    place = (stacked.location.x, stacked.location.y, stacked.location.z + 0.025)
    assert bpy.ops.palpate.stroke(place=place, radius=RADIUS, depth=0.006) == {"FINISHED"}
    assert layer_names(stacked) == ["Rests", "Press 1"]
    # It gives way: its top comes down, and with it the upper one.
    assert np.abs(sag(free_cube) - sagged).max() > 3e-4
    assert stacked.location.z < before[1][2, 3] - 3e-4
    assert bpy.ops.palpate.reset_rest() == {"FINISHED"}
    assert layer_names(free_cube) == []


def test_a_stroke_that_is_given_up_gives_all_back(free_cube, stacked):
    before, sagged = matrices(free_cube, stacked), sag(free_cube)
    body = part("operators.object.drawn_body").open_body(stacked, bpy.context.scene)
    grips = part("operators.stroke.answer.grips").grips_at(
        body, np.array([0.0, 0.0, 0.025]), RADIUS, (False, False, False)
    )
    motion = part("operators.stroke.answer.motion")
    live, drawing = part("operators.layer.live_layer"), part("operators.stroke.stroke_drawing")
    begun = part("operators.stroke.answer.free_stroke").FreeStroke.begin(stacked, body, grips)
    begun.make_ready(stacked)
    live.hang(stacked)
    for depth in (0.002, 0.004, 0.006, 0.006):
        _, made = begun.towards(motion.Asked(motion.Motion.PUSH, depth))
        drawing.draw(stacked, begun, made)
    # The lower one gives way while the pointer is held.
    assert np.abs(sag(free_cube) - sagged).max() > 2e-4
    live.remove(stacked)
    begun.give_back(stacked)
    np.testing.assert_array_equal(matrices(free_cube, stacked), before)
    np.testing.assert_array_equal(sag(free_cube), sagged)


def test_what_is_carried_off_leaves_the_other_to_spring_back(free_cube, stacked):
    sagged = np.abs(sag(free_cube)).max()
    select(stacked)
    side = (stacked.location.x + 0.025, stacked.location.y, stacked.location.z)
    way = (0.09, 0.0, 0.004)
    done = bpy.ops.palpate.stroke(motion="GRAB", place=side, radius=RADIUS, by=way)
    assert done == {"FINISHED"}
    assert stacked.location.z == pytest.approx(0.025, abs=3e-3)
    assert np.abs(sag(free_cube)).max() < 0.8 * sagged


@pytest.fixture
def plate(stacked, tmp_path):
    """A plate that comes down on the upper one by 4 mm in the frames 1 to 8, and goes again."""
    scene, made = bpy.context.scene, bpy.data.collections.new("Plate")
    scene.frame_start, scene.frame_end, scene.render.fps = 1, 12, 12
    bpy.ops.mesh.primitive_cube_add(size=1.0, scale=(0.03, 0.03, 0.01))
    board = bpy.context.object
    made.objects.link(board)
    top = stacked.location.z + 0.025
    for frame, over in ((1, 0.004), (8, -0.004), (12, 0.012)):
        board.location = (stacked.location.x, stacked.location.y, top + over + 0.005)
        board.keyframe_insert("location", frame=frame)
    select(stacked)
    stacked.palpate.pressers = made
    scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "stacked.blend"))
    return made


def played(things, frames):
    """Matrix and seen places of each object in frames."""
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        found.append([(np.array(one.matrix_world), seen_places(one).copy()) for one in things])
    return found


def test_both_are_baked_together_and_play_the_same_again(free_cube, stacked, plate):
    things, frames = (free_cube, stacked), (1, 4, 8, 12)
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    for one in things:
        assert [modifier.type for modifier in one.modifiers] == ["MESH_CACHE"]
        assert one.animation_data is not None
    first = played(things, frames)
    heights = [np.ptp((places @ matrix[:3, :3].T)[:, 2]) for (matrix, places), _ in first]
    # The lower one is squeezed while the plate is down, and springs back.
    assert heights[2] < heights[0] - 3e-4
    assert heights[3] > heights[2] + 2e-4
    assert first[2][1][0][2, 3] < first[0][1][0][2, 3] - 5e-4
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    for one, other in zip(first, played(things, frames), strict=True):
        for (matrix, places), (again, there) in zip(one, other, strict=True):
            np.testing.assert_allclose(again, matrix, rtol=0.0, atol=2e-5)
            np.testing.assert_allclose(there, places, rtol=0.0, atol=2e-5)
    # Reset takes both animations back.
    assert bpy.ops.palpate.reset_rest() == {"FINISHED"}
    assert [list(one.modifiers) for one in things] == [[], []]


def test_a_pinned_one_that_keyframes_move_is_refused(free_cube, stacked, plate):
    free_cube.palpate.pin_mode = "BELOW"
    select(free_cube)
    assert bpy.ops.palpate.update_pins() == {"FINISHED"}
    free_cube.keyframe_insert("location", frame=1)
    select(stacked)
    assert "stands still" in error_of(bpy.ops.palpate.press_frames)
    assert stacked.animation_data is None
