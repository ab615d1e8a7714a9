"""Animations of objects that nobody holds: keyframes place them, the surface is in the cache."""

from __future__ import annotations

import csv

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, mesh_state, part, seen_places, select


@pytest.fixture
def hand(free_cube, tmp_path):
    """Two boards that come from both sides, hold the cube, and lift it, in the frames 1 to 12."""
    free_cube.palpate.static_friction = 1.0
    scene, made = bpy.context.scene, bpy.data.collections.new("Hand")
    scene.frame_start, scene.frame_end, scene.render.fps = 1, 12, 12
    for side in (-1.0, 1.0):
        bpy.ops.mesh.primitive_cube_add(size=1.0, scale=(0.02, 0.06, 0.04))
        board = bpy.context.object
        made.objects.link(board)
        for frame, x, z in ((1, 0.036, 0.0), (4, 0.032, 0.0), (11, 0.032, 0.04)):
            board.location = (side * x, 0.0, z)
            board.keyframe_insert("location", frame=frame)
    select(free_cube)
    free_cube.palpate.pressers = None
    scene.frame_set(1)
    assert bpy.ops.palpate.settle() == {"FINISHED"}
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lifted.blend"))
    free_cube.palpate.pressers = made
    return made


def heights(thing, frames):
    """Where the object and its lowest vertex are in frames."""
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        matrix = np.array(thing.matrix_world)
        places = seen_places(thing) @ matrix[:3, :3].T + matrix[:3, 3]
        found.append((thing.location.z, places[:, 2].min()))
    return np.array(found)


def test_a_cube_is_held_between_two_boards_and_lifted(free_cube, hand):
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    assert layer_names(free_cube) == []
    at = heights(free_cube, (1, 4, 8, 11))
    assert at[0, 1] == pytest.approx(-0.025, abs=2e-4)
    # It follows the hand, but for what it slips.
    assert at[3, 0] - at[1, 0] == pytest.approx(0.04, abs=4e-3)
    assert at[3, 1] > 0.01
    bpy.context.scene.frame_set(6)
    held = seen_places(free_cube).copy()
    before = heights(free_cube, range(1, 13))
    # Baked again it comes to the same, from the same start.
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    np.testing.assert_allclose(heights(free_cube, range(1, 13)), before, rtol=0, atol=2e-5)
    bpy.context.scene.frame_set(6)
    np.testing.assert_allclose(seen_places(free_cube), held, rtol=0, atol=2e-5)


def test_reset_takes_the_animation_back(free_cube, hand):
    before = np.array(free_cube.palpate.laid_from).reshape(4, 4)
    bpy.ops.palpate.press_frames()
    assert "Reset" in error_of(bpy.ops.palpate.settle)
    assert bpy.ops.palpate.reset_rest() == {"FINISHED"}
    bpy.context.scene.frame_set(10)
    np.testing.assert_allclose(free_cube.matrix_world, before, rtol=0, atol=1e-6)
    assert [one.name for one in free_cube.modifiers] == []


def test_forces_of_the_hand_are_told_in_the_world(free_cube, hand, tmp_path):
    table = tmp_path / "forces.csv"
    bpy.ops.palpate.press_frames(forces=str(table))
    with table.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["frame"] == "12"]
    lifted = -sum(float(row["force_z_N"]) for row in rows)
    weight = free_cube.palpate.density * 0.05**3 * 9.81
    assert len(rows) == 2
    # It still swings a little.
    assert lifted == pytest.approx(weight, rel=0.2)


def test_live_pressers_and_other_files_are_refused_with_the_remedy(free_cube, hand):
    bpy.context.scene.frame_set(5)
    failures = part("operators.animation.failures")
    assert "Bake Animation" in str(failures.reason(free_cube))
    before = mesh_state(free_cube)
    assert "Mesh Cache" in error_of(bpy.ops.palpate.press_frames, current_only=True)
    free_cube.keyframe_insert("location", frame=1)
    assert "keyframes" in error_of(bpy.ops.palpate.press_frames)
    assert mesh_state(free_cube) == before


def test_a_hand_steadies_it_under_pressers_live_and_baked(free_cube, hand):
    """One board alone comes from the side: it is dented and stays where it is."""
    hand.objects.unlink(hand.objects[0])
    free_cube.palpate.steady = True
    bpy.context.scene.frame_set(5)
    assert not part("operators.animation.failures").reason(free_cube)
    live = np.abs(seen_places(free_cube) - at_rest_places(free_cube)).max()
    assert live > 2e-4
    before = np.array(free_cube.matrix_world)
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    for frame in range(1, 13):
        bpy.context.scene.frame_set(frame)
        now = np.array(free_cube.matrix_world)
        np.testing.assert_allclose(now[:3, :3], before[:3, :3], atol=1e-5)
        np.testing.assert_allclose(now[:2, 3], before[:2, 3], atol=1e-5)
    bpy.context.scene.frame_set(5)
    assert np.abs(seen_places(free_cube) - at_rest_places(free_cube)).max() > 2e-4


def at_rest_places(thing):
    """Vertices (p, 3) of its own mesh."""
    return np.array([vertex.co for vertex in thing.data.vertices])
