"""A soft object that moves while its animation is pressed: referee is the same press at rest."""

from __future__ import annotations

import csv

import bpy
import numpy as np
import pytest
from mathutils import Euler
from pressed_scene import tapped_by_ball
from soft_scene import empty, error_of, part, seen_places, select

FRAMES = range(1, 8)


@pytest.fixture
def tapped(palpate, tmp_path):
    thing, scene = tapped_by_ball(), bpy.context.scene
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    thing.palpate.static_friction = 0.5
    # Beside the middle of the top, where it would touch either of two alike.
    bpy.data.objects["Ball"].delta_location = (0.0043, 0.0017, 0.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "tapped.blend"))
    return thing


def carry(*things):
    """Let all things be carried along, turned and thrown, within the frames."""
    vehicle = empty("Vehicle", at=(0.0, 0.0, 0.0))
    for frame, place, turn in (
        (1, (0.3, -0.2, 0.1), (0.4, 0.2, 0.0)),
        (7, (-0.5, 1.0, 2.0), (2, 1, 3)),
    ):
        vehicle.location, vehicle.rotation_euler = place, Euler(turn)
        vehicle.keyframe_insert("location", frame=frame)
        vehicle.keyframe_insert("rotation_euler", frame=frame)
    for one in things:
        one.parent = vehicle
    return vehicle


def baked(thing, tmp_path):
    """Places (7, p, 3) that an animation plays, local units, and the forces (7, 3), world axes."""
    table, scene = tmp_path / "forces.csv", bpy.context.scene
    select(thing)
    assert bpy.ops.palpate.press_frames(forces=str(table)) == {"FINISHED"}
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    places = []
    for frame in FRAMES:
        scene.frame_set(frame)
        places.append(seen_places(thing))
    return np.array(places), np.array([[float(row[f"force_{k}_N"]) for k in "xyz"] for row in rows])


def test_a_body_that_moves_is_pressed_as_at_rest(tapped, tmp_path):
    rest, straight = baked(tapped, tmp_path)
    assert np.abs(rest[3] - rest[0]).max() > 2e-4
    vehicle = carry(tapped, bpy.data.objects["Ball"])
    moving, forces = baked(tapped, tmp_path)
    # What Blender holds a metre away it knows to a ten thousandth of a millimetre.
    np.testing.assert_allclose(moving, rest, rtol=0, atol=0.01 * np.abs(rest[3] - rest[0]).max())
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        turn = np.array(vehicle.matrix_world)[:3, :3]
        aside = 0.02 * np.linalg.norm(straight, axis=1).max()
        np.testing.assert_allclose(forces[frame - 1], turn @ straight[frame - 1], atol=aside)


def test_a_body_that_is_scaled_meanwhile_is_refused(tapped):
    for frame, scale in ((1, 1.0), (3, 1.0), (5, 1.5)):
        tapped.scale = (scale,) * 3
        tapped.keyframe_insert("scale", frame=frame)
    bpy.context.scene.frame_set(1)
    select(tapped)
    said = error_of(bpy.ops.palpate.press_frames)
    assert "frame 4" in said
    assert "scale" in said
    assert not [one for one in tapped.modifiers if one.type == "MESH_CACHE"]
    folder = part("operators.object.body_store").folder_for_new_files()
    assert not list(folder.glob("*.pc2"))
